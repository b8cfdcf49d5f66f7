#include "carving/thin_parts.h"

#include <gtest/gtest.h>

#include "carving/fit_grid.h"
#include "support/analytic_volumes.h"
#include "support/silhouettes.h"

namespace photohull::carving {
namespace {

using glm::dvec3;

const Box kBox{dvec3(-1), dvec3(1)};
constexpr double kVoxel = 2.0 / 40;

struct Scene {
  GridSpec grid = fit_grid(kBox, kVoxel);
  std::vector<Camera> cameras = test::cameras_around(dvec3(0), 6, 14, 700, 256, 256);
  std::vector<test::Outline> outlines;

  std::vector<Silhouette> silhouettes() const {
    std::vector<Silhouette> out;
    for (const test::Outline& outline : outlines) out.push_back({&outline.mask, &outline.distance});
    return out;
  }

  SparseVolume hull() const {
    const std::vector<Silhouette> all = silhouettes();
    return sample_volume(
        grid.bricks,
        [&](const dvec3& p) {
          return reference::hull_distance({grid, kBox}, {cameras, all}, {}, glm::ivec3(p));
        },
        grid.origin, grid.voxel_size);
  }

  std::size_t keep(SparseVolume& volume) const {
    return keep_thin_parts(volume, kBox, cameras, silhouettes(), {});
  }
};

/// Share of a line's points whose nearest voxel, or one beside it, is inside.
double covered(const SparseVolume& volume, const dvec3& a, const dvec3& b) {
  int inside = 0;
  constexpr int kPoints = 400;
  for (int i = 0; i < kPoints; ++i) {
    const dvec3 p = (glm::mix(a, b, (i + 0.5) / kPoints) - volume.grid.origin) / kVoxel;
    inside += volume.at(glm::ivec3(glm::floor(p + 0.5))) < 0;
  }
  return double(inside) / kPoints;
}

TEST(KeepThinParts, WireBetweenVoxelCentres) {
  const dvec3 a(-0.71, -0.52, 0.03), b(0.73, 0.44, 0.31);
  Scene scene;
  for (const Camera& camera : scene.cameras)
    scene.outlines.push_back(test::wire_outline(camera, a, b, 0.2 * kVoxel));
  SparseVolume volume = scene.hull();
  const double before = covered(volume, a, b);
  const std::size_t inside = volume.inside_voxels(), changed = scene.keep(volume);
  EXPECT_LT(before, 0.35);
  EXPECT_GT(covered(volume, a, b), 0.9);
  EXPECT_EQ(volume.inside_voxels(), inside + changed);
  // Nothing but voxels that the wire passes through.
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot)
    for (int i = 0; i < kBrickVoxels; ++i) {
      if (volume.distance[slot * kBrickVoxels + std::size_t(i)] >= 0) continue;
      const dvec3 p = volume.grid.world(dvec3(volume.bricks[slot] * kBrickEdge) +
                                        dvec3(i >> 6, (i >> 3) & 7, i & 7));
      const double t = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
      if (t < 0 || t > 1) continue;  // the outlines leave the ends open
      EXPECT_LT(glm::distance(p, a + t * (b - a)), 1.1 * kVoxel);
    }
}

TEST(KeepThinParts, ThickPartsStayAsTheyAre) {
  Scene scene;
  for (const Camera& camera : scene.cameras)
    scene.outlines.push_back(test::sphere_outline(camera, {0.1, 0, -0.05}, 0.6));
  SparseVolume volume = scene.hull();
  const std::vector<float> before = volume.distance;
  scene.keep(volume);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) changed += before[i] != volume.distance[i];
  // Cones of few views meet in ridges sharper than a sphere; few of them pass between voxels.
  EXPECT_LT(changed, 0.001 * double(volume.inside_voxels()));
}

TEST(KeepThinParts, SpeckSmallerThanAVoxel) {
  const dvec3 centre = fit_grid(kBox, kVoxel).world({20.5, 20.5, 20.5});
  Scene scene;
  for (const Camera& camera : scene.cameras)
    scene.outlines.push_back(test::sphere_outline(camera, centre, 0.3 * kVoxel));
  SparseVolume volume = scene.hull();
  EXPECT_EQ(volume.inside_voxels(), 0u);
  scene.keep(volume);
  EXPECT_GE(volume.inside_voxels(), 1u);
  EXPECT_LE(volume.inside_voxels(), 8u);
}

TEST(KeepThinParts, NothingWithoutSilhouettes) {
  Scene scene;
  scene.outlines.resize(scene.cameras.size());
  std::vector<Silhouette> none(scene.cameras.size());
  SparseVolume volume =
      sample_volume(scene.grid.bricks, sphere(dvec3(20), 0.4), scene.grid.origin, kVoxel);
  EXPECT_EQ(keep_thin_parts(volume, kBox, scene.cameras, none, {}), 0u);
}

}  // namespace
}  // namespace photohull::carving
