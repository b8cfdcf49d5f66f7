// Lines of photographs whose middle and width are known, beside masks that lack them.
#include "masks/photo_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "masks/drawn_masks.h"
#include "masks/silhouette.h"
#include "support/cameras.h"
#include "support/pictures.h"

namespace photohull {
namespace {

using glm::dvec2;
using glm::vec3;

constexpr int kSize = 96;
const vec3 kObject(0.2f, 0.5f, 0.1f), kDark(0.03f, 0.03f, 0.04f), kBright(0.7f, 0.7f, 0.72f);
const dvec2 kFrom(30, 12), kTo(84, 80);  ///< ends of the line
const dvec2 kAlong = glm::normalize(kTo - kFrom), kAcross(-kAlong.y, kAlong.x);

using Ground = std::function<vec3(double x, double y)>;

/// A leaf that the mask holds and a stem that it lacks.
struct Scene {
  Scene(double width, const Ground& ground, double noise = 0) {
    test::Drawing leaf(kSize, kSize), all(kSize, kSize);
    leaf.add_disc({20, 70}, 9);
    all.add_disc({20, 70}, 9);
    if (width > 0) all.add_band(kFrom, kTo, width);
    truth = all.mask();
    test::Rng rng(7);
    view.image = paint_srgb(kSize, kSize, [&](double x, double y) {
      const float share = truth.coverage[std::size_t(y) * kSize + std::size_t(x)] / 255.0f;
      vec3 colour = glm::mix(ground(x, y), kObject, share);
      for (int c = 0; c < 3 && noise > 0; ++c) {
        const double root = std::sqrt(double(colour[c])) + noise * test::uniform(rng, -1.7, 1.7);
        colour[c] = float(root * root);
      }
      return colour;
    });
    view.mask = leaf.mask();
    distance = silhouette_distance(view.mask);
  }
  std::vector<LinePoint> find(double noise = 0) const {
    return find_photo_lines(view, distance, {noise});
  }

  PreparedView view;
  Mask truth;  ///< of leaf and stem
  SilhouetteDistance distance;
};

Ground plain(const vec3& colour) {
  return [colour](double, double) { return colour; };
}

/// Share of the stem's length beside which there are points.
double share_found(const std::vector<LinePoint>& lines, double within = 0.35) {
  int found = 0;
  const double length = glm::distance(kFrom, kTo);
  for (int i = 3; i < int(length) - 3; ++i)
    found += std::any_of(lines.begin(), lines.end(), [&](const LinePoint& p) {
      const dvec2 off = dvec2(p.x, p.y) - (kFrom + double(i) * kAlong);
      return std::abs(glm::dot(off, kAlong)) <= 1 && std::abs(glm::dot(off, kAcross)) <= within;
    });
  return found / (int(length) - 6.0);
}

TEST(FindPhotoLines, AStemIsFoundBeforeDarkAndBrightGround) {
  for (const vec3& ground : {kDark, kBright})
    for (const double width : {0.3, 0.6, 1.0, 2.0}) {
      SCOPED_TRACE(testing::Message() << width << " px before " << ground.r);
      const std::vector<LinePoint> lines = Scene(width, plain(ground)).find();
      EXPECT_GT(share_found(lines), 0.95);
      double sum = 0;
      for (const LinePoint& p : lines) {
        sum += p.width;
        EXPECT_LT(std::abs(glm::dot(dvec2(p.x, p.y) - kFrom, kAcross)), 1);
        const double t = glm::dot(dvec2(p.x, p.y) - kFrom, kAlong);
        if (t < 4 || t > glm::distance(kFrom, kTo) - 4) continue;
        EXPECT_GT(std::abs(p.normal_x * kAcross.x + p.normal_y * kAcross.y), 0.9);
      }
      EXPECT_NEAR(sum / double(lines.size()), width, 0.1 * width + 0.05);
    }
}

TEST(FindPhotoLines, NoiseHasNone) {
  const double noise = 0.02;
  EXPECT_LT(Scene(0, plain(kBright), noise).find(noise).size(), 5u);
  EXPECT_GT(share_found(Scene(1, plain(kBright), noise).find(noise), 0.6), 0.9);
}

TEST(FindPhotoLines, EdgesAndWideBandsAreNone) {
  const Ground edge = [](double x, double) { return x < 52.3 ? kDark : kBright; };
  EXPECT_TRUE(Scene(0, edge).find().empty());
  EXPECT_TRUE(Scene(6, plain(kBright)).find().empty());
  EXPECT_GT(share_found(Scene(1, edge).find()), 0.5);  // not where it crosses the edge
}

TEST(FindPhotoLines, NothingWithinTheMaskOrBesideWhatWasNotPhotographed) {
  Scene scene(1, plain(kDark));
  test::Drawing all(kSize, kSize);
  all.add_disc({20, 70}, 9);
  all.add_band(kFrom - 2.0 * kAlong, kTo + 2.0 * kAlong, 3);
  scene.view.mask = all.mask();
  scene.distance = silhouette_distance(scene.view.mask);
  EXPECT_TRUE(scene.find().empty());
  Scene other(1, plain(kDark));
  other.view.image.has_alpha = true;
  for (std::size_t i = 0; i < other.truth.coverage.size(); ++i)
    if (i % kSize > kSize / 2) other.view.image.bytes[4 * i + 3] = 0;
  for (const LinePoint& p : other.find()) EXPECT_LT(p.x, kSize / 2);
  EXPECT_LT(share_found(other.find()), 0.5);
}

TEST(RestoreLines, GivesTheShareOfEachPixelBeforePlainGround) {
  for (const double width : {0.4, 1.0, 2.0}) {
    Scene scene(width, plain(kDark));
    restore_lines(scene.find(), {}, scene.distance, scene.view);
    double worst = 0;
    for (int y = 4; y < kSize - 4; ++y)
      for (int x = 4; x < kSize - 4; ++x) {
        const dvec2 p(x, y);
        const double t = glm::dot(p - kFrom, kAlong);
        if (t < 4 || t > glm::distance(kFrom, kTo) - 4) continue;
        const std::size_t i = std::size_t(y) * kSize + std::size_t(x);
        worst = std::max(worst,
                         std::abs(scene.view.mask.coverage[i] - double(scene.truth.coverage[i])));
      }
    EXPECT_LT(worst, 0.1 * 255) << width;
  }
}

TEST(RestoreLines, PlacesThatOtherViewsShowAreLookedAt) {
  Scene scene(1, plain(kDark));
  std::vector<dvec2> places;
  for (int i = 10; i < 60; ++i) places.push_back(kFrom + double(i) * kAlong + 0.5 * kAcross);
  restore_lines({}, places, scene.distance, scene.view);
  const dvec2 middle = kFrom + 35.0 * kAlong;
  const auto at = [&](const dvec2& p) {
    return scene.view.mask
        .coverage[std::size_t(std::lround(p.y)) * kSize + std::size_t(std::lround(p.x))];
  };
  EXPECT_GT(at(middle), 100);
  EXPECT_EQ(at(middle + 5.0 * kAcross), 0);
}

TEST(RestoreLines, BeforeTextureALineIsABandAndPlacesAddNothing) {
  test::Rng rng(3);
  std::vector<float> grey;
  for (int i = 0; i < kSize * kSize; ++i) grey.push_back(float(test::uniform(rng, 0, 1)));
  Scene scene(
      0, [&](double x, double y) { return vec3(grey[std::size_t(y) * kSize + std::size_t(x)]); });
  const Mask before = scene.view.mask;
  const std::vector<dvec2> places{{60, 30}, {61, 31}};
  restore_lines({}, places, scene.distance, scene.view);
  EXPECT_EQ(scene.view.mask.coverage, before.coverage);
  std::vector<LinePoint> line;
  for (int y = 20; y < 60; ++y) line.push_back({70, float(y), 1, 0, 0.5f});
  restore_lines(line, {}, scene.distance, scene.view);
  EXPECT_EQ(scene.view.mask.coverage[40 * kSize + 70], 128);
  EXPECT_EQ(scene.view.mask.coverage[40 * kSize + 72], 0);
}

TEST(DrawLines, TheirCoverageSumsToTheirWidth) {
  for (const float width : {0.2f, 1.0f, 2.6f})
    for (const float x : {20.0f, 20.3f, 20.5f}) {
      Mask mask{48, 48, std::vector<std::uint8_t>(48 * 48)};
      std::vector<LinePoint> line;
      for (int y = 5; y < 40; ++y) line.push_back({x, float(y), 1, 0, width});
      draw_lines(line, mask);
      double sum = 0;
      for (int i = 0; i < 48; ++i) sum += mask.coverage[20 * 48 + std::size_t(i)] / 255.0;
      EXPECT_NEAR(sum, width, 0.01) << x;
    }
}

}  // namespace
}  // namespace photohull
