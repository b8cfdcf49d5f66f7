#include "volume/distance_from_mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

using glm::dvec3;
using glm::ivec3;

/// Calls f(voxel, distance there) for all voxels of a volume's grid.
template <typename F>
void for_voxels(const SparseVolume& volume, F&& f) {
  const ivec3 n = volume.grid.voxels();
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) f(ivec3(x, y, z), double(volume.at({x, y, z})));
}

/// The grid with voxels half as large over the same space.
GridSpec finer(const GridSpec& grid) {
  return {grid.origin - 0.25 * grid.voxel_size, 0.5 * grid.voxel_size, 2 * grid.bricks};
}

void expect_consistent(const SparseVolume& volume) {
  EXPECT_EQ(volume.table.size(), volume.grid.brick_count());
  EXPECT_EQ(volume.distance.size(), volume.bricks.size() * kBrickVoxels);
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot)
    EXPECT_EQ(volume.table[volume.grid.brick_index(volume.bricks[slot])], slot);
  for (const float d : volume.distance) {
    EXPECT_LE(std::abs(d), SparseVolume::kBand);
  }
}

/// Greatest error of the distances that lie within `reach`, and of the signs beyond 0.05 voxels.
void expect_distances(const SparseVolume& volume, const Distance& truth, double reach,
                      double bound) {
  expect_consistent(volume);
  double worst = 0;
  int wrong_signs = 0;
  for_voxels(volume, [&](const ivec3& voxel, double d) {
    const double expected = truth(dvec3(voxel));
    if (std::abs(expected) < reach) worst = std::max(worst, std::abs(d - expected));
    wrong_signs += std::abs(expected) > bound && (d < 0) != (expected < 0);
  });
  EXPECT_LT(worst, bound);
  EXPECT_EQ(wrong_signs, 0);
}

class OfASphere : public testing::TestWithParam<double> {
 protected:
  const dvec3 centre_{31.8, 32.1, 31.3};
  const SparseVolume volume_ =
      sample_volume({8, 8, 8}, sphere(centre_, GetParam()), {3, -1, 2}, 0.1);
  const TriMesh mesh_ = extract_mesh(volume_);
};

TEST_P(OfASphere, AtTheSameVoxelSize) {
  expect_distances(distance_from_mesh(mesh_, volume_, volume_.grid), sphere(centre_, GetParam()),
                   2.5, 0.05);
}

// Twentieths of the mesh's own voxels: between its vertices tangent planes pass above the sphere.
TEST_P(OfASphere, AtHalfTheVoxelSize) {
  expect_distances(distance_from_mesh(mesh_, volume_, finer(volume_.grid)),
                   sphere(2.0 * centre_ + 0.5, 2 * GetParam()), 2.5, 0.1);
}

TEST_P(OfASphere, BeyondTheReachOnlySides) {
  const SparseVolume near = distance_from_mesh(mesh_, volume_, volume_.grid, 1.5);
  expect_distances(near, sphere(centre_, GetParam()), 1.4, 0.05);
  for_voxels(near, [&](const ivec3& voxel, double d) {
    const double expected = sphere(centre_, GetParam())(dvec3(voxel));
    if (std::abs(expected) > 1.7) {
      EXPECT_EQ(std::abs(d), SparseVolume::kBand);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Radii, OfASphere, testing::Values(11.3, 26.0));

TEST(DistanceFromMesh, BricksWithoutSurfaceAreInsideOrOutside) {
  const dvec3 centre(31.5);
  const SparseVolume volume = sample_volume({8, 8, 8}, sphere(centre, 26));
  const SparseVolume again = distance_from_mesh(extract_mesh(volume), volume, volume.grid);
  EXPECT_EQ(again.table[again.grid.brick_index({4, 4, 4})], SparseVolume::kInside);
  EXPECT_EQ(again.table[again.grid.brick_index({0, 0, 0})], SparseVolume::kOutside);
  EXPECT_NEAR(double(again.inside_voxels()), double(volume.inside_voxels()),
              0.001 * double(volume.inside_voxels()));
}

TEST(DistanceFromMesh, FacesOfABoxAndAThinPlate) {
  for (const double thickness : {1.3, 12.0}) {
    const Distance truth = box(dvec3(5.3), {26.4, 26.2, 5.3 + thickness});
    const SparseVolume volume = sample_volume({4, 4, 4}, truth);
    const SparseVolume again = distance_from_mesh(extract_mesh(volume), volume, volume.grid);
    expect_consistent(again);
    for_voxels(again, [&](const ivec3& voxel, double d) {
      const double expected = truth(dvec3(voxel));
      // Away from the edges, which the lattice rounds.
      const bool amid = voxel.x > 9 && voxel.x < 23 && voxel.y > 9 && voxel.y < 23;
      if (amid && std::abs(expected) < 2) {
        EXPECT_NEAR(d, expected, 0.05);
      }
      if (std::abs(expected) > 0.5) {
        EXPECT_EQ(d < 0, expected < 0);
      }
    });
  }
}

TEST(DistanceFromMesh, LargeTrianglesArePointsAllOver) {
  const Distance truth = box(dvec3(6), dvec3(26));
  const SparseVolume volume = sample_volume({4, 4, 4}, truth);
  const TriMesh merged = extract_mesh(volume, std::vector<std::uint8_t>(64, 1));
  ASSERT_LT(merged.positions.size(), 0.5 * double(extract_mesh(volume).positions.size()));
  const SparseVolume again = distance_from_mesh(merged, volume, volume.grid);
  for_voxels(again, [&](const ivec3& voxel, double d) {
    const double expected = truth(dvec3(voxel));
    if (std::abs(expected) > 0.5) {
      EXPECT_EQ(d < 0, expected < 0);
    }
  });
}

TEST(DistanceFromMesh, WhatLiesOutsideTheGridIsCutOff) {
  const dvec3 centre(15.5);
  const SparseVolume volume = sample_volume({4, 4, 4}, sphere(centre, 11));
  const SparseVolume half =
      distance_from_mesh(extract_mesh(volume), volume, {dvec3(0), 1, {2, 4, 4}});
  expect_distances(half, sphere(centre, 11), 2.5, 0.05);
}

TEST(DistanceFromMesh, EmptyMeshLeavesTheSides) {
  SparseVolume volume = sample_volume({2, 2, 2}, [](const dvec3&) { return 5.0; });
  const SparseVolume outside = distance_from_mesh({}, volume, volume.grid);
  EXPECT_TRUE(outside.bricks.empty());
  EXPECT_EQ(outside.inside_voxels(), 0u);
  std::fill(volume.table.begin(), volume.table.end(), SparseVolume::kInside);
  EXPECT_EQ(distance_from_mesh({}, volume, volume.grid).inside_voxels(), 16u * 16 * 16);
}

TEST(DistanceFromMesh, NonsenseVerticesNeitherStallNorSpread) {
  const dvec3 centre(15.5);
  const SparseVolume volume = sample_volume({4, 4, 4}, sphere(centre, 11));
  TriMesh mesh = extract_mesh(volume);
  const auto n = std::uint32_t(mesh.positions.size());
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const float x : {kNan, 1e30f, -std::numeric_limits<float>::infinity()}) {
    mesh.positions.emplace_back(x);
    mesh.normals.emplace_back(0, 0, 1);
  }
  mesh.triangles.push_back({0, 1, n});
  mesh.triangles.push_back({n, n + 1, n + 2});
  mesh.triangles.push_back({5, 5, 5});
  expect_distances(distance_from_mesh(mesh, volume, volume.grid), sphere(centre, 11), 2.5, 0.05);
}

class MovedSphere : public testing::TestWithParam<double> {};

TEST_P(MovedSphere, HasTheRadiusThatItShould) {
  const dvec3 centre(15.8, 16.1, 15.3);
  SparseVolume volume = sample_volume({4, 4, 4}, sphere(centre, 9), {1, 2, 3}, 0.25);
  const TriMesh mesh = extract_mesh(volume);
  move_surface(volume, mesh, std::vector<float>(mesh.positions.size(), float(GetParam())));
  expect_consistent(volume);
  const TriMesh moved = extract_mesh(volume);
  ASSERT_GT(moved.positions.size(), 100u);
  EXPECT_EQ(open_edges(moved), 0u);
  for (std::size_t i = 0; i < moved.positions.size(); ++i) {
    const dvec3 at = (moved.world(i) - volume.grid.origin) / 0.25;
    EXPECT_NEAR(glm::distance(at, centre), 9 + GetParam(), 0.06);
  }
}

INSTANTIATE_TEST_SUITE_P(By, MovedSphere, testing::Values(-1.5, -0.4, 0.0, 0.7, 1.5));

TEST(MoveSurface, LargeTrianglesMoveAsAWhole) {
  const Distance truth = box(dvec3(6), dvec3(42));
  SparseVolume volume = sample_volume({6, 6, 6}, truth);
  const TriMesh merged = extract_mesh(volume, std::vector<std::uint8_t>(216, 1));
  ASSERT_LT(4 * merged.positions.size(), extract_mesh(volume).positions.size());
  move_surface(volume, merged, std::vector<float>(merged.positions.size(), 0.8f));
  for (int x = 14; x < 34; ++x)
    for (int y = 14; y < 34; ++y)
      EXPECT_NEAR(volume.at({x, y, 42}), truth({x, y, 42}) - 0.8, 0.05) << x << ' ' << y;
}

TEST(MoveSurface, OnlyWhereItIsTold) {
  const dvec3 centre(15.5);
  SparseVolume volume = sample_volume({4, 4, 4}, sphere(centre, 9));
  const SparseVolume before = volume;
  const TriMesh mesh = extract_mesh(volume);
  std::vector<float> moves;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    moves.push_back(mesh.world(i).z > 20 ? 1.0f : 0.0f);
  move_surface(volume, mesh, moves);
  for_voxels(volume, [&](const ivec3& voxel, double d) {
    if (voxel.z < 17) {
      EXPECT_EQ(d, before.at(voxel));
    }
    EXPECT_LE(d, before.at(voxel) + 1e-6);
  });
  EXPECT_NEAR(volume.at({16, 16, 25}), before.at({16, 16, 25}) - 1, 0.05);
}

TEST(DistanceFromMesh, SlabsChangeNothing) {
  const SparseVolume volume = sample_volume({4, 5, 6}, torus({16, 20, 24}, 11, 4.5));
  const TriMesh mesh = extract_mesh(volume);
  std::vector<float> moves;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    moves.push_back(float(std::sin(double(i))));
  const SparseVolume whole = distance_from_mesh(mesh, volume, volume.grid, 2.25);
  SparseVolume moved = volume;
  move_surface(moved, mesh, moves);
  for (const std::size_t at_once : {std::size_t(1), std::size_t(100), mesh.positions.size() / 2}) {
    const SparseVolume parts = distance_from_mesh(mesh, volume, volume.grid, 2.25, at_once);
    EXPECT_EQ(parts.table, whole.table);
    EXPECT_EQ(parts.bricks, whole.bricks);
    EXPECT_EQ(parts.distance, whole.distance);
    SparseVolume moved_in_parts = volume;
    move_surface(moved_in_parts, mesh, moves, at_once);
    EXPECT_EQ(moved_in_parts.distance, moved.distance);
  }
}

}  // namespace
}  // namespace photohull
