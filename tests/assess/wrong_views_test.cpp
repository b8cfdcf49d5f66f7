#include "assess/wrong_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/silhouettes.h"

namespace photohull::assess {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int kWidth = 120, kHeight = 90;
const Box kBox{{-1, -1, -1}, {1, 1, 1}};

struct Scene {
  std::vector<Camera> cameras = test::cameras_around({0, 0, 0}, 5, 16, 180, kWidth, kHeight);
  std::vector<test::Outline> outlines;
  std::vector<const SilhouetteDistance*> silhouettes;

  /// Of two spheres, the second off the middle, so that turning a camera shows.
  explicit Scene(double radius = 0.5) {
    for (const Camera& camera : cameras) outlines.push_back(seen_by(camera, radius));
    for (const test::Outline& outline : outlines) silhouettes.push_back(&outline.distance);
  }

  static test::Outline seen_by(const Camera& camera, double radius) {
    const auto a = test::sphere_outline(camera, {0.3, 0.2, 0.1}, radius);
    const auto b = test::sphere_outline(camera, {-0.4, -0.3, 0.3}, radius / 2);
    return test::rasterise(kWidth, kHeight, [&](const glm::dvec2& p) {
      const std::size_t i = std::size_t(p.y) * kWidth + std::size_t(p.x);
      return double(std::min(a.distance.pixels[i], b.distance.pixels[i]));
    });
  }

  SilhouetteConsistency find() const { return find_wrong_views(kBox, cameras, silhouettes); }
};

Camera moved(const Camera& camera, const glm::dvec3& by) {
  return test::look_at(camera.center() + by, by, camera.intrinsics.fx, kWidth, kHeight);
}

TEST(WrongViews, ConsistentSilhouettesBlameNobody) {
  const SilhouetteConsistency found = Scene().find();
  EXPECT_EQ(found.uncovered, 0);
  EXPECT_THAT(found.wrong, IsEmpty());
}

TEST(WrongViews, NamesCamerasThatAreElsewhere) {
  Scene scene;
  scene.cameras[3] = moved(scene.cameras[3], {0.3, 0.3, 0});
  scene.cameras[10] = moved(scene.cameras[10], {0, -0.4, 0.3});
  const SilhouetteConsistency found = scene.find();
  EXPECT_THAT(found.wrong, ElementsAre(3, 10));
  EXPECT_GT(found.uncovered, 0.05);
  EXPECT_LE(found.uncovered_left, 0.002);
}

TEST(WrongViews, NamesAMaskOfHalfTheObject) {
  Scene scene;
  auto& pixels = scene.outlines[5].distance.pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth / 2; ++x) pixels[std::size_t(y) * kWidth + x] = 20;
  EXPECT_THAT(scene.find().wrong, ElementsAre(5));
}

TEST(WrongViews, APixelOfErrorIsTolerated) {
  Scene scene;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    scene.cameras[i].intrinsics.cx += i % 2 ? 1 : -1;
  EXPECT_THAT(scene.find().wrong, IsEmpty());
}

// A hole in every mask contradicts too, but leaving views out mends nothing.
TEST(WrongViews, MasksThatAreAllTornBlameNobody) {
  Scene scene;
  for (auto& outline : scene.outlines) {
    const auto middle =
        std::min_element(outline.distance.pixels.begin(), outline.distance.pixels.end()) -
        outline.distance.pixels.begin();
    const glm::dvec2 centre(double(middle % kWidth), double(middle / kWidth));
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        float& d = outline.distance.pixels[std::size_t(y) * kWidth + x];
        d = std::max(d, float(8 - glm::distance(centre, glm::dvec2(x, y))));
      }
  }
  const SilhouetteConsistency found = scene.find();
  EXPECT_GT(found.uncovered, 0.1);
  EXPECT_THAT(found.wrong, IsEmpty());
  EXPECT_EQ(found.uncovered_left, found.uncovered);
}

TEST(WrongViews, ViewsWithoutMaskAndForegroundBesideTheBoxSayNothing) {
  Scene scene;
  for (std::size_t i = 0; i < scene.silhouettes.size(); i += 2) scene.silhouettes[i] = nullptr;
  // Of the two spheres the smaller one stands beside this box.
  const Box box{{-0.2, -0.3, -0.4}, {0.8, 0.7, 0.6}};
  const SilhouetteConsistency found = find_wrong_views(box, scene.cameras, scene.silhouettes);
  EXPECT_LT(found.uncovered, 0.002);
  EXPECT_THAT(found.wrong, IsEmpty());
}

TEST(WrongViews, TooFewViewsAccuseNobody) {
  Scene scene;
  scene.cameras.resize(4), scene.silhouettes.resize(4);
  scene.cameras[1] = moved(scene.cameras[1], {0.3, 0.3, 0});
  EXPECT_THAT(scene.find().wrong, IsEmpty());
  EXPECT_THAT(find_wrong_views(kBox, {}, {}).wrong, IsEmpty());
}

}  // namespace
}  // namespace photohull::assess
