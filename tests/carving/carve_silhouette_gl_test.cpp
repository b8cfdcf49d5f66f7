// The whole visual hull, coarse to fine, against the dense evaluation of its reference.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "carving/fit_grid.h"
#include "carving/hull_kernels.h"
#include "core/error.h"
#include "support/gl_context.h"

namespace photohull::carving {
namespace {

using glm::ivec3;
using test_kernels::HullScene;

const glm::dvec3 kCentre(10, -4, 2.5);
constexpr double kRadius = 0.8;

/// Box of half size 1 around kCentre with `resolution` voxels along, seen by cameras around it.
HullScene scene_around(int resolution, int cameras, double focal = 190, int width = 160,
                       int height = 120) {
  HullScene scene;
  scene.box = {kCentre - 1.0, kCentre + 1.0};
  scene.grid = fit_grid(scene.box, voxel_size_for(scene.box, resolution));
  scene.cameras = test::cameras_around(kCentre, 4, cameras, focal, width, height);
  return scene;
}

class CarveSilhouette : public ::testing::Test {
 protected:
  void TearDown() override { context_.check_errors("carve silhouette test"); }

  SparseVolume carve(const HullScene& scene, HullReport* report = nullptr) {
    return carve_silhouette(context_, {scene.grid, scene.box}, {scene.cameras, scene.silhouettes()},
                            scene.options, progress_, report);
  }

  gpu::Context& context_ = test::gl_context();
  Progress progress_;
};

template <typename F>
void for_each_voxel(const GridSpec& grid, F&& f) {
  const ivec3 size = grid.voxels();
  for (int x = 0; x < size.x; ++x)
    for (int y = 0; y < size.y; ++y)
      for (int z = 0; z < size.z; ++z) f(ivec3(x, y, z));
}

/// The sparse result against the reference at every voxel: the sign everywhere, the value where it
/// matters to the surface. Deeper inside, views that cannot touch the surface are left out.
void expect_equals_dense(const SparseVolume& volume, const HullScene& scene) {
  const std::vector<Silhouette> silhouettes = scene.silhouettes();
  const double bound = test_kernels::distance_bound();
  int wrong_sign = 0;
  double worst = 0;
  for_each_voxel(volume.grid, [&](const ivec3& voxel) {
    const double expected = reference::hull_distance(
        {scene.grid, scene.box}, {scene.cameras, silhouettes}, scene.options, voxel);
    const double found = volume.at(voxel);
    if (std::abs(expected) > bound) wrong_sign += (expected < 0) != (found < 0);
    if (std::abs(expected) < 0.9) worst = std::max(worst, std::abs(found - expected));
  });
  EXPECT_EQ(wrong_sign, 0);
  EXPECT_LT(worst, bound);
}

HullScene sphere_scene(int resolution, int cameras) {
  HullScene scene = scene_around(resolution, cameras);
  for (const Camera& camera : scene.cameras)
    scene.outlines.push_back(test::sphere_outline(camera, kCentre, kRadius));
  return scene;
}

TEST_F(CarveSilhouette, SphereSeenByTwelveCameras) {
  const HullScene scene = sphere_scene(60, 12);
  const SparseVolume volume = carve(scene);
  expect_equals_dense(volume, scene);
  const double voxel = std::pow(scene.grid.voxel_size, 3);
  const double sphere = 4.0 / 3 * glm::pi<double>() * std::pow(kRadius, 3);
  // Twelve cones leave a little more than the sphere; measured: 1.010.
  EXPECT_NEAR(double(volume.inside_voxels()) * voxel / sphere, 1.01, 0.02);
}

TEST_F(CarveSilhouette, NoPointOfTheObjectIsCarved) {
  const HullScene scene = sphere_scene(60, 12);
  const SparseVolume volume = carve(scene);
  int missing = 0;
  for_each_voxel(volume.grid, [&](const ivec3& voxel) {
    const double depth = kRadius - glm::distance(scene.grid.world(voxel), kCentre);
    missing += depth > 0.1 * scene.grid.voxel_size && volume.at(voxel) >= 0;
  });
  EXPECT_EQ(missing, 0);
}

TEST_F(CarveSilhouette, WiresOfAboutOnePixelSurviveCoarseToFine) {
  // At their distance a pixel is 0.021 wide and a voxel 0.018.
  for (const double radius : {0.0105, 0.014}) {
    HullScene scene = scene_around(112, 6);
    const glm::dvec3 a = kCentre - glm::dvec3(0.8, 0.5, 0.6),
                     b = kCentre + glm::dvec3(0.7, 0.8, 0.4);
    for (const Camera& camera : scene.cameras)
      scene.outlines.push_back(test::wire_outline(camera, a, b, radius));
    const SparseVolume volume = carve(scene);
    EXPECT_GT(volume.inside_voxels(), 50u) << radius;
    expect_equals_dense(volume, scene);
  }
}

TEST_F(CarveSilhouette, WithoutMasksTheFrustaBoundTheBox) {
  HullScene scene = scene_around(40, 5, 330);  // the images show a part of the box
  scene.outlines.resize(5);
  for (const int min_views : {2, 4}) {
    scene.options.min_views = min_views;
    const SparseVolume volume = carve(scene);
    expect_equals_dense(volume, scene);
    EXPECT_GT(volume.inside_voxels(), 0u);
    EXPECT_LT(volume.inside_voxels(), 40u * 40 * 40);
  }
}

TEST_F(CarveSilhouette, WithoutMasksAWhollyVisibleBoxStays) {
  HullScene scene = scene_around(24, 3, 120);
  scene.outlines.resize(3);
  const SparseVolume volume = carve(scene);
  expect_equals_dense(volume, scene);
  EXPECT_EQ(volume.inside_voxels(), 24u * 24 * 24);
}

TEST_F(CarveSilhouette, MixesViewsWithAndWithoutMasksAndSizes) {
  HullScene scene = sphere_scene(40, 6);
  scene.outlines[2] = {};
  scene.cameras.push_back(test::look_at(kCentre + glm::dvec3(5, 0, 0), kCentre, 120, 90, 70));
  scene.outlines.push_back(test::sphere_outline(scene.cameras.back(), kCentre, kRadius));
  expect_equals_dense(carve(scene), scene);
}

TEST_F(CarveSilhouette, NothingIsLeftOfEmptyMasks) {
  HullScene scene = scene_around(24, 3);
  for (int i = 0; i < 3; ++i)
    scene.outlines.push_back(test::rasterise(160, 120, [](const glm::dvec2&) { return 32768.0; }));
  const SparseVolume volume = carve(scene);
  EXPECT_EQ(volume.inside_voxels(), 0u);
  EXPECT_TRUE(volume.bricks.empty());
}

TEST_F(CarveSilhouette, ReportsItsWorkAndStopsWhenAsked) {
  const HullScene scene = sphere_scene(40, 6);
  HullReport report;
  const SparseVolume volume = carve(scene, &report);
  EXPECT_GE(report.bricks_evaluated, std::int64_t(volume.bricks.size()));
  EXPECT_GT(report.nodes_tested, 0);
  EXPECT_LE(report.samples, report.bricks_evaluated * kBrickVoxels * 6);
  process_cancellation().cancel();
  EXPECT_THROW(carve(scene), Cancelled);
  process_cancellation().reset();
}

TEST_F(CarveSilhouette, TwoRunsGiveTheSameBytes) {
  const HullScene scene = sphere_scene(40, 6);
  const SparseVolume a = carve(scene), b = carve(scene);
  EXPECT_EQ(a.table, b.table);
  EXPECT_EQ(a.bricks, b.bricks);
  EXPECT_EQ(a.distance, b.distance);
}

TEST_F(CarveSilhouette, SmallImagesAreNotMixedWithThePaddingOfLargeOnes) {
  HullScene scene = scene_around(40, 3, 150, 64, 64);
  scene.outlines.resize(3);
  scene.cameras.push_back(test::look_at(kCentre + glm::dvec3(0, 5, 1), kCentre, 120, 160, 120));
  scene.outlines.push_back(test::sphere_outline(scene.cameras.back(), kCentre, kRadius));
  // Silhouettes that the image border cuts: their distance is not zero there.
  for (int i = 0; i < 3; ++i)
    scene.outlines[i] = test::rasterise(64, 64, [](const glm::dvec2& p) { return 30.5 - p.y; });
  expect_equals_dense(carve(scene), scene);
}

TEST_F(CarveSilhouette, PointsThatNoImageShowsAreJudgedAlikeAtEveryLevel) {
  HullScene scene = scene_around(40, 3, 500);  // the images show the middle of the box
  scene.outlines.resize(3);
  scene.options.min_views = 1;
  expect_equals_dense(carve(scene), scene);
}

test::Outline nothing(const Camera& camera) {
  return test::rasterise(camera.intrinsics.width, camera.intrinsics.height,
                         [](const glm::dvec2&) { return 32768.0; });
}

/// A view that would leave everything out if what it does not have on its image counted.
void add_empty_view(HullScene& scene, const Camera& camera) {
  scene.cameras.push_back(camera);
  scene.outlines.push_back(nothing(camera));
}

TEST_F(CarveSilhouette, AnEmptySilhouetteOfEightTakesTheBallUnlessOneMayMiss) {
  HullScene scene = sphere_scene(40, 8);
  const std::uint64_t whole = carve(scene).inside_voxels();
  scene.outlines[3] = nothing(scene.cameras[3]);
  EXPECT_EQ(carve(scene).inside_voxels(), 0u);
  scene.options.views_may_miss = 1;
  SparseVolume volume = carve(scene);
  expect_equals_dense(volume, scene);
  // Of the other seven silhouettes none may miss anything: nothing of the ball is lost, and where
  // all eight masks are right what one of them cuts off comes back.
  EXPECT_GE(volume.inside_voxels(), whole);
  EXPECT_LT(double(volume.inside_voxels()), 1.3 * double(whole));
  scene.outlines[5] = nothing(scene.cameras[5]);
  EXPECT_EQ(carve(scene).inside_voxels(), 0u);
  scene.options.views_may_miss = 2;
  EXPECT_GE(carve(scene).inside_voxels(), whole);
}

TEST_F(CarveSilhouette, HullsThatMoreMayMissContainEachOther) {
  HullScene scene = sphere_scene(32, 6);
  std::vector<SparseVolume> hulls;
  for (int missing = 0; missing <= 7; ++missing) {
    scene.options.views_may_miss = missing;
    hulls.push_back(carve(scene));
    expect_equals_dense(hulls.back(), scene);
  }
  for (std::size_t i = 1; i < hulls.size(); ++i)
    for_each_voxel(scene.grid, [&](const ivec3& voxel) {
      EXPECT_LE(hulls[i].at(voxel), hulls[i - 1].at(voxel) + 1e-3f);
    });
  // Where all silhouettes may miss, the box is what is left.
  EXPECT_EQ(hulls[6].inside_voxels(), 32u * 32 * 32);
  EXPECT_EQ(hulls[7].inside_voxels(), 32u * 32 * 32);
}

TEST_F(CarveSilhouette, AViewLeavesNothingOutThatIsBesideItsFrame) {
  HullScene scene = sphere_scene(40, 8);
  const std::uint64_t whole = carve(scene).inside_voxels();
  // The ball stands to the left of the frame.
  add_empty_view(scene, test::look_at(kCentre + glm::dvec3(4, 0, 0), kCentre + glm::dvec3(0, 5, 0),
                                      190, 160, 120));
  const SparseVolume volume = carve(scene);
  expect_equals_dense(volume, scene);
  EXPECT_EQ(volume.inside_voxels(), whole);
  // Nor does it use up the one that may miss.
  add_empty_view(scene, test::look_at(kCentre + glm::dvec3(0, 4, 0), kCentre, 190, 160, 120));
  EXPECT_EQ(carve(scene).inside_voxels(), 0u);
  scene.options.views_may_miss = 1;
  EXPECT_GE(carve(scene).inside_voxels(), whole);
}

TEST_F(CarveSilhouette, AViewLeavesNothingOutThatIsBehindItsCamera) {
  HullScene scene = sphere_scene(40, 8);
  const std::uint64_t whole = carve(scene).inside_voxels();
  // It looks away from the ball, whose mirror image would fall into the frame.
  add_empty_view(scene, test::look_at(kCentre + glm::dvec3(4, 0, 0), kCentre + glm::dvec3(9, 0, 0),
                                      190, 160, 120));
  const SparseVolume volume = carve(scene);
  expect_equals_dense(volume, scene);
  EXPECT_EQ(volume.inside_voxels(), whole);
  add_empty_view(scene, test::look_at(kCentre + glm::dvec3(0, 4, 0), kCentre, 190, 160, 120));
  EXPECT_EQ(carve(scene).inside_voxels(), 0u);
  scene.options.views_may_miss = 1;
  EXPECT_GE(carve(scene).inside_voxels(), whole);
}

TEST_F(CarveSilhouette, ViewsWithoutSilhouettesMissNothing) {
  HullScene scene = sphere_scene(40, 8);
  for (const int view : {0, 4, 6}) scene.outlines[view] = {};
  scene.outlines[1] = nothing(scene.cameras[1]);
  scene.options.views_may_miss = 1;
  const SparseVolume volume = carve(scene);
  expect_equals_dense(volume, scene);
  EXPECT_GT(volume.inside_voxels(), 0u);
  scene.options.views_may_miss = 0;
  EXPECT_EQ(carve(scene).inside_voxels(), 0u);
}

}  // namespace
}  // namespace photohull::carving
