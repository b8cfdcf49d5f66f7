// What masks show of thin rods, where a camera or a mask is off.
#include "carving/missing_parts.h"

#include <gtest/gtest.h>

#include <numbers>

#include "carving/fit_grid.h"
#include "carving/rods.h"
#include "carving/thin_parts.h"
#include "masks/mask_lines.h"
#include "masks/silhouette.h"
#include "support/analytic_volumes.h"

namespace photohull::carving {
namespace {

using glm::dvec3;
using test::Rod;

constexpr int kWidth = 256;
constexpr double kDistance = 6, kFocal = 700;
constexpr double kPixel = kDistance / kFocal;  ///< world size of a pixel at the rod
const Box kBox{dvec3(-0.8), dvec3(0.8)};
const Rod kRod = test::straight_rod({-0.55, -0.45, -0.5}, {0.5, 0.6, 0.4}, 0.6 * kPixel);

/// A view's mask prepared as the pipeline does.
struct PreparedMask {
  explicit PreparedMask(Mask mask) : given(std::move(mask)) { prepare(); }
  void prepare() {
    lines = find_lines(given);
    widened = given;
    widen_lines(lines, widened);
    distance = silhouette_distance(widened);
  }
  Silhouette silhouette() const { return {&widened, &distance, &lines}; }

  Mask given, widened;
  std::vector<LinePoint> lines;
  SilhouetteDistance distance;
};

struct Scene {
  explicit Scene(int views, const std::vector<Rod>& rods = {kRod})
      : Scene(test::cameras_around(dvec3(0), kDistance, views, kFocal, kWidth, kWidth), rods) {}
  Scene(const std::vector<Camera>& of, const std::vector<Rod>& rods) : cameras(of) {
    for (const Camera& camera : cameras) {
      test::Drawing drawing(kWidth, kWidth);
      for (const Rod& rod : rods) draw(rod, camera, drawing);
      masks.emplace_back(drawing.mask());
    }
  }

  /// The view's camera is said to look elsewhere: the rod seems to be so far beside its place.
  void put_off(int view, double pixels = 3) {
    Camera& camera = cameras[std::size_t(view)];
    const glm::dvec2 along = *camera.project(kRod.axis[1]) - *camera.project(kRod.axis[0]);
    camera.intrinsics.cx -= pixels * along.y / glm::length(along);
    camera.intrinsics.cy += pixels * along.x / glm::length(along);
  }
  std::vector<Silhouette> silhouettes() const {
    std::vector<Silhouette> out;
    for (const PreparedMask& m : masks)
      out.push_back(m.given.empty() ? Silhouette{} : m.silhouette());
    return out;
  }
  MissingParts find(const MissingOptions& options = {}, const Box& box = kBox) const {
    return find_missing_parts(box, cameras, silhouettes(), options);
  }
  bool mend(const std::vector<MissingPart>& parts) {
    bool any = false;
    for (std::size_t i = 0; i < masks.size(); ++i) {
      if (!mend_silhouette(parts, cameras[i], masks[i].distance, kMendThinParts, masks[i].widened))
        continue;
      masks[i].distance = silhouette_distance(masks[i].widened);
      any = true;
    }
    return any;
  }
  /// Share of the rod's axis beside which, by two pixels at most, the hull has something.
  double share_in_hull() const {
    const GridSpec grid = fit_grid(kBox, kPixel);
    const std::vector<Silhouette> all = silhouettes();
    SparseVolume hull = sample_volume(
        grid.bricks,
        [&](const dvec3& p) {
          if (kRod.distance(grid.world(p)) > 8 * kPixel) return double(SparseVolume::kBand);
          return reference::hull_distance({grid, kBox}, {cameras, all}, {}, glm::ivec3(p));
        },
        grid.origin, grid.voxel_size);
    keep_thin_parts(hull, kBox, cameras, all, {});
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
      const dvec3 p = glm::mix(kRod.axis[0], kRod.axis[1], (i + 0.5) / 400);
      const glm::ivec3 voxel((p - grid.origin) / grid.voxel_size + 0.5);
      bool found = false;
      for (int n = 0; n < 125; ++n)
        found = found || hull.at(voxel + glm::ivec3(n % 5, n / 5 % 5, n / 25) - 2) < 0;
      inside += found;
    }
    return inside / 400.0;
  }

  std::vector<Camera> cameras;
  std::vector<PreparedMask> masks;
};

ForegroundCounts sum(const MissingParts& found) {
  ForegroundCounts all;
  for (const ForegroundCounts& v : found.views)
    all.looked_at += v.looked_at, all.unexplained += v.unexplained, all.placed += v.placed;
  return all;
}

/// The view that is off lets a part be up to three pixels beside the rod, in its own rays; most
/// parts are no farther than all other views bear.
void expect_on_rod(const MissingParts& found, const Rod& rod = kRod) {
  std::vector<double> pixels;
  for (const MissingPart& part : found.parts) {
    pixels.push_back(rod.distance(part.centre) / kPixel);
    EXPECT_LT(part.radius, 2 * rod.radius);
  }
  if (pixels.empty()) return;
  std::sort(pixels.begin(), pixels.end());
  EXPECT_LT(pixels[pixels.size() / 2], 1.6);
  EXPECT_LT(pixels.back(), 3.5);
}

TEST(FindMissingParts, NothingWhereAllViewsAreRight) {
  for (const int views : {9, 18}) {
    const MissingParts found = Scene(views).find();
    ASSERT_EQ(found.views.size(), std::size_t(views));
    EXPECT_GT(sum(found).looked_at, 60 * views);
    EXPECT_EQ(sum(found).unexplained, 0) << views;
    EXPECT_EQ(sum(found).placed, 0);
    expect_on_rod(found);
  }
}

TEST(FindMissingParts, ARodThatOneViewHasElsewhereIsFoundAndMended) {
  for (const int views : {9, 12, 18}) {
    Scene scene(views);
    EXPECT_GT(scene.share_in_hull(), 0.95) << views;
    scene.put_off(2);
    EXPECT_LT(scene.share_in_hull(), 0.1) << views;
    const MissingParts found = scene.find();
    EXPECT_GT(sum(found).unexplained, 0.5 * sum(found).looked_at) << views;
    EXPECT_GT(sum(found).placed, 0.85 * sum(found).unexplained) << views;
    expect_on_rod(found);
    EXPECT_TRUE(scene.mend(found.parts));
    EXPECT_GT(scene.share_in_hull(), 0.97) << views;
    EXPECT_LT(sum(scene.find()).unexplained, 0.1 * sum(found).unexplained) << views;
  }
}

TEST(FindMissingParts, NothingIsPlacedThatTooManyViewsMiss) {
  Scene scene(12);
  scene.put_off(1);
  MissingOptions none;
  none.most_missing = 0;
  const MissingParts found = scene.find(none);
  EXPECT_GT(sum(found).unexplained, 500);
  EXPECT_LT(sum(found).placed, 0.05 * sum(found).unexplained);
  // Half of the views are off, each in its own way.
  for (int i = 3; i < 8; ++i) scene.put_off(i, (i % 2 ? 4 : -4) * i);
  EXPECT_LT(sum(scene.find()).placed, 0.1 * sum(scene.find()).unexplained);
}

TEST(FindMissingParts, ABlobInOneMaskIsNotPlaced) {
  Scene scene(12);
  for (int i = 0; i < 3; ++i) {
    test::Drawing drawing(kWidth, kWidth);
    draw(kRod, scene.cameras[4], drawing);
    drawing.add_disc({60, 200}, i == 2 ? 12 : 3);
    if (i > 0) drawing.add_band({150, 20}, {230, 30}, 1);  // a line is as false
    scene.masks[4] = PreparedMask(drawing.mask());
    const MissingParts found = scene.find();
    EXPECT_GT(found.views[4].unexplained, 0) << i;
    EXPECT_EQ(sum(found).placed, 0) << i;
    expect_on_rod(found);
  }
}

TEST(FindMissingParts, WhatStandsBesideTheBoxIsNotPlacedInIt) {
  // From many sides it shows in front of the box or behind it.
  const Box small{dvec3(-0.45), dvec3(0.45)};
  const Rod inside = test::straight_rod({-0.3, -0.3, -0.35}, {0.3, 0.35, 0.3}, kRod.radius);
  const Rod beside = test::straight_rod({0.6, -0.4, -0.6}, {0.62, 0.5, 0.6}, kRod.radius);
  Scene scene(14, {inside, beside});
  EXPECT_EQ(sum(scene.find({}, small)).unexplained, 0);
  scene.put_off(3);
  MissingParts found = scene.find({}, small);
  std::erase_if(found.parts, [&](const MissingPart& p) { return !small.contains(p.centre); });
  EXPECT_GT(found.parts.size(), 100u);
  expect_on_rod(found, inside);
}

TEST(FindMissingParts, ViewsWithoutSilhouetteDoNotCount) {
  Scene scene(12);
  scene.put_off(2);
  const int before = sum(scene.find()).placed;
  for (const int view : {5, 7, 8}) scene.masks[std::size_t(view)].given = {};
  const MissingParts found = scene.find();
  for (const int view : {5, 7, 8}) {
    EXPECT_EQ(found.views[std::size_t(view)].looked_at, 0);
    EXPECT_EQ(found.views[std::size_t(view)].unexplained, 0);
  }
  EXPECT_GT(sum(found).placed, 0.5 * before);
  expect_on_rod(found);
}

TEST(FindMissingParts, ViewsThatDoNotHaveAPointOnTheirImageDoNotCount) {
  const Scene whole(9);
  std::vector<Camera> cameras = whole.cameras;
  // Half of these frames' rod is cut off; the last one stands behind another camera, looking away.
  for (int i = 0; i < 4; ++i) cameras.push_back(cameras[std::size_t(i)]);
  for (int i = 9; i < 13; ++i) cameras[std::size_t(i)].intrinsics.cx += 128;
  Scene scene(cameras, {kRod});
  const dvec3 eye(4, 1, 1);
  scene.cameras.push_back(test::look_at(eye, 2.0 * eye, kFocal, kWidth, kWidth));
  scene.masks.emplace_back(Mask{kWidth, kWidth, std::vector<std::uint8_t>(kWidth * kWidth, 0)});
  EXPECT_EQ(sum(scene.find()).unexplained, 0);
  scene.put_off(2);
  const MissingParts found = scene.find();
  EXPECT_GT(sum(found).placed, 0.85 * sum(found).unexplained);
  expect_on_rod(found);
  EXPECT_TRUE(scene.mend(found.parts));
  EXPECT_GT(scene.share_in_hull(), 0.97);
}

TEST(FindMissingParts, FewerThanFourViewsPlaceNothing) {
  MissingOptions two;
  two.least_support = 2;
  for (const int views : {2, 3, 5}) {
    Scene scene(views);
    scene.put_off(1, 5);
    EXPECT_EQ(sum(scene.find(two)).placed > 0, views == 5) << views;
  }
}

TEST(FindMissingParts, EnoughViewsMustShowUnexplainedForeground) {
  Scene scene(12);
  scene.put_off(2);
  MissingOptions options;
  options.least_support = 11;
  EXPECT_GT(sum(scene.find(options)).placed, 0);
  options.least_support = 13;
  EXPECT_EQ(sum(scene.find(options)).placed, 0);
  options = {};
  options.support_share = 1.01;
  EXPECT_EQ(sum(scene.find(options)).placed, 0);
}

TEST(FindMissingParts, DoubtfulForegroundOfMadeMasksAsksForNothing) {
  Scene scene(12);
  Mask& mask = scene.masks[4].given;
  for (int y = 190; y < 210; ++y)
    for (int x = 50; x < 70; ++x) mask.coverage[std::size_t(y * kWidth + x)] = 160;
  scene.masks[4].prepare();
  std::vector<Silhouette> silhouettes = scene.silhouettes();
  const auto unexplained = [&] {
    return find_missing_parts(kBox, scene.cameras, silhouettes, {}).views[4].unexplained;
  };
  EXPECT_GT(unexplained(), 0);
  silhouettes[4].likelihood = true;
  EXPECT_EQ(unexplained(), 0);
}

TEST(FindMissingParts, TwoRunsGiveTheSame) {
  Scene scene(12);
  scene.put_off(2);
  const MissingParts a = scene.find(), b = scene.find();
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_EQ(a.parts[i].centre, b.parts[i].centre);
    EXPECT_EQ(a.parts[i].radius, b.parts[i].radius);
  }
  for (std::size_t v = 0; v < a.views.size(); ++v) {
    EXPECT_EQ(a.views[v].unexplained, b.views[v].unexplained);
    EXPECT_EQ(a.views[v].placed, b.views[v].placed);
  }
}

TEST(FindMissingParts, NothingWithoutSilhouettesOrForeground) {
  Scene scene(6, {});
  EXPECT_EQ(sum(scene.find()).looked_at, 0);
  for (PreparedMask& m : scene.masks) m.given = {};
  EXPECT_TRUE(scene.find().parts.empty());
}

/// A disc that a camera sees.
class MendSilhouette : public testing::Test {
 protected:
  MendSilhouette() {
    test::Drawing drawing(kWidth, kWidth);
    drawing.add_disc({127.5, 127.5}, 20);
    before = drawing.mask();
    distance = silhouette_distance(before);
  }
  /// A place at the distance of what the camera looks at.
  dvec3 world(double x, double y) const {
    const dvec3 ray = camera.ray({x, y});
    return camera.center() + ray * (kDistance / ray.z);
  }

  const Camera camera = test::look_at({0, 0, -kDistance}, {}, kFocal, kWidth, kWidth);
  Mask before;
  SilhouetteDistance distance;
};

TEST_F(MendSilhouette, GapsAreFilledOnlyWhereThePartLacks) {
  const auto part = [&](double off) {  // pixels outside the disc
    return std::vector<MissingPart>{{world(127.5 + 20 + off, 127.5), 2 * kPixel}};
  };
  Mask mask = before;
  EXPECT_FALSE(mend_silhouette(part(0.2), camera, distance, kMendGaps, mask));
  EXPECT_EQ(mask.coverage, before.coverage);
  EXPECT_TRUE(mend_silhouette(part(0.2), camera, distance, kMendThinParts, mask));
  mask = before;
  EXPECT_TRUE(mend_silhouette(part(5), camera, distance, kMendGaps, mask));
  int added = 0;
  for (std::size_t i = 0; i < mask.coverage.size(); ++i)
    added += mask.coverage[i] - before.coverage[i];
  EXPECT_NEAR(added / 255.0, std::numbers::pi * 2 * 2, 0.6);  // its own size, without room
}

TEST_F(MendSilhouette, DrawsPartsThatAreNotWellWithin) {
  Mask mask = before;
  EXPECT_FALSE(mend_silhouette({}, camera, distance, kMendThinParts, mask));
  const std::vector<MissingPart> within{{world(130, 120), 2 * kPixel}};
  EXPECT_FALSE(mend_silhouette(within, camera, distance, kMendThinParts, mask));
  const std::vector<MissingPart> nowhere{{dvec3(0, 0, -2 * kDistance), kPixel},
                                         {world(300, 128), kPixel}};
  EXPECT_FALSE(mend_silhouette(nowhere, camera, distance, kMendThinParts, mask));
  EXPECT_EQ(mask.coverage, before.coverage);
  const std::vector<MissingPart> beside{{world(200, 60), 2 * kPixel}};
  EXPECT_TRUE(mend_silhouette(beside, camera, distance, kMendThinParts, mask));
  for (int y = 0; y < kWidth; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto i = std::size_t(y * kWidth + x);
      const double off = std::hypot(x - 200, y - 60);
      if (off < 1.5) {
        EXPECT_EQ(mask.coverage[i], 255);
      } else if (off > 4) {
        EXPECT_EQ(mask.coverage[i], before.coverage[i]);
      }
    }
}

TEST(FindMissingParts, WhatWasNotPhotographedIsNotLookedAt) {
  const Scene scene(4);
  ColourImage nothing{kWidth, kWidth, ColourImage::Encoding::kSrgb8, true, {}};
  nothing.bytes.assign(4 * std::size_t(kWidth) * kWidth, 0);
  std::vector<Silhouette> silhouettes = scene.silhouettes();
  silhouettes[1].image = &nothing;
  const MissingParts found = find_missing_parts(kBox, scene.cameras, silhouettes, {});
  EXPECT_GT(found.views[0].looked_at, 0);
  EXPECT_EQ(found.views[1].looked_at, 0);
}

}  // namespace
}  // namespace photohull::carving
