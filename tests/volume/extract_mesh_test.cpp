#include "volume/extract_mesh.h"

#include <gtest/gtest.h>

#include <random>

#include "support/analytic_volumes.h"

namespace photohull {
namespace {

const glm::dvec3 kCenter(31.3, 32.1, 30.7);  // off the lattice

struct Deviation {
  double distance = 0;  ///< voxels, of vertices from the analytic surface
  double angle = 0;     ///< degrees, of normals from the analytic gradient
};

Deviation largest_deviation(const SparseVolume& volume, const TriMesh& mesh,
                            const Distance& distance) {
  Deviation worst;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3 p = (mesh.world(i) - volume.grid.origin) / volume.grid.voxel_size;
    worst.distance = std::max(worst.distance, std::abs(distance(p)));
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0);
      step[axis] = 1e-4;
      gradient[axis] = distance(p + step) - distance(p - step);
    }
    const double cosine = glm::dot(glm::normalize(gradient), glm::dvec3(mesh.normals[i]));
    worst.angle = std::max(worst.angle, glm::degrees(std::acos(std::min(cosine, 1.0))));
  }
  return worst;
}

void expect_sound(const TriMesh& mesh) {
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_GT(smallest_area(mesh), 0.0);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const glm::vec3& normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1.0f, 1e-5f);
}

TEST(ExtractMesh, Sphere) {
  const Distance distance = sphere(kCenter, 20);
  const SparseVolume volume = sample_volume(glm::ivec3(8), distance);
  const TriMesh mesh = extract_mesh(volume);
  expect_sound(mesh);
  const Deviation worst = largest_deviation(volume, mesh, distance);
  EXPECT_LT(worst.distance, 0.02);
  EXPECT_LT(worst.angle, 0.5);
  EXPECT_NEAR(signed_volume(mesh) / (4.0 / 3.0 * M_PI * 8000), 1.0, 0.01);
}

TEST(ExtractMesh, Torus) {
  const Distance distance = torus(kCenter, 18, 6);
  const SparseVolume volume = sample_volume(glm::ivec3(8), distance);
  const TriMesh mesh = extract_mesh(volume);
  expect_sound(mesh);
  const Deviation worst = largest_deviation(volume, mesh, distance);
  EXPECT_LT(worst.distance, 0.05);
  EXPECT_LT(worst.angle, 2.0);
  EXPECT_NEAR(signed_volume(mesh) / (2 * M_PI * M_PI * 18 * 36), 1.0, 0.01);
  // One handle: vertices - edges + faces = 0, with 3/2 edges per face.
  EXPECT_EQ(2 * mesh.positions.size(), mesh.triangles.size());
}

TEST(ExtractMesh, BoxWithFacesOnVoxelCentres) {
  const Distance distance = box({10, 10, 10}, {40, 41, 42});
  const TriMesh mesh = extract_mesh(sample_volume(glm::ivec3(8), distance));
  expect_sound(mesh);
  EXPECT_NEAR(signed_volume(mesh) / (30 * 31 * 32), 1.0, 0.01);
  // Flat faces stay flat, their normals exact, away from the box's edges.
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3 p = mesh.world(i);
    if (p.x > 12 && p.x < 38 && p.y > 12 && p.y < 39 && p.z > 30) {
      EXPECT_NEAR(p.z, 42, 1e-3);
      EXPECT_GT(mesh.normals[i].z, 0.999f);
    }
  }
}

TEST(ExtractMesh, WorldCoordinatesFollowTheGrid) {
  const glm::dvec3 origin(1e6, -2e6, 3e6);
  const SparseVolume volume = sample_volume(glm::ivec3(8), sphere(kCenter, 20), origin, 0.001);
  const TriMesh mesh = extract_mesh(volume);
  EXPECT_EQ(mesh.origin, volume.grid.bounds().center());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    ASSERT_NEAR(glm::length(mesh.world(i) - (origin + 0.001 * kCenter)), 0.020, 5e-5);
}

// OpenVDB takes voxels of such a size for nothing.
TEST(ExtractMesh, TinyVoxelsGiveTheSameMesh) {
  const Distance distance = sphere(kCenter, 20);
  SparseVolume volume = sample_volume(glm::ivec3(8), distance);
  volume.grid.voxel_size *= 1e-9;
  volume.grid.origin *= 1e-9;
  const TriMesh mesh = extract_mesh(volume);
  expect_sound(mesh);
  EXPECT_LT(largest_deviation(volume, mesh, distance).distance, 0.02);
}

TEST(ExtractMesh, BodyCutByTheBorderIsClosedThere) {
  const TriMesh mesh =
      extract_mesh(sample_volume(glm::ivec3(6), box({-10, -10, -10}, {100, 25, 26})));
  expect_sound(mesh);
  // The grid's own box ends half a voxel beyond the outermost centres.
  EXPECT_NEAR(signed_volume(mesh) / (48 * 25.5 * 26.5), 1.0, 0.01);
  double low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    low = std::min(low, mesh.world(i).x);
    high = std::max(high, mesh.world(i).x);
  }
  EXPECT_NEAR(low, -0.5, 0.05);
  EXPECT_NEAR(high, 47.5, 0.05);
}

TEST(ExtractMesh, UnstoredInsideBricksAreClosed) {
  SparseVolume volume = sample_volume(glm::ivec3(3), [](const glm::dvec3&) { return 9.0; });
  volume.table[volume.grid.brick_index({1, 1, 1})] = SparseVolume::kInside;
  const TriMesh mesh = extract_mesh(volume);
  expect_sound(mesh);
  EXPECT_NEAR(signed_volume(mesh) / 512, 1.0, 0.05);  // Its edges are cut at half a voxel.
  volume.table.assign(27, SparseVolume::kInside);
  const TriMesh full = extract_mesh(volume);
  expect_sound(full);
  EXPECT_NEAR(signed_volume(full) / (24 * 24 * 24), 1.0, 0.01);
}

TEST(ExtractMesh, NoiseIsClosedAndManifold) {
  for (const double inside : {0.1, 0.5, 0.8}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> value(-4 * inside, 4 * (1 - inside));
    const SparseVolume volume =
        sample_volume(glm::ivec3(3), [&](const glm::dvec3&) { return value(random); });
    for (const int kept : {1, 2, 27}) {  // one brick in so many stays fine
      std::vector<std::uint8_t> coarse;
      for (int i = 0; i < 27; ++i) coarse.push_back(i % kept != 0);
      const TriMesh mesh = extract_mesh(volume, coarse);
      EXPECT_GT(mesh.triangles.size(), 1000u);
      EXPECT_EQ(open_edges(mesh), 0u) << inside << ' ' << kept;
      EXPECT_GT(signed_volume(mesh), 0);
    }
  }
}

TEST(ExtractMesh, ValuesThatTouchZeroGiveNoFlatTriangles) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> value(-1, 1);
  const TriMesh mesh = extract_mesh(sample_volume(
      glm::ivec3(3), [&](const glm::dvec3&) { return 1e-7 * value(random) + value(random); }));
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_GT(smallest_area(mesh), 0.0);
}

TEST(ExtractMesh, CoarseBricksShareVertices) {
  const Distance distance = sphere(kCenter, 25);
  const SparseVolume volume = sample_volume(glm::ivec3(8), distance);
  std::vector<std::uint8_t> flags(volume.table.size(), 1);
  const TriMesh fine = extract_mesh(volume), coarse = extract_mesh(volume, flags);
  expect_sound(coarse);
  EXPECT_LT(2 * coarse.triangles.size(), fine.triangles.size());
  const Deviation worst = largest_deviation(volume, coarse, distance);
  EXPECT_LT(worst.distance, 0.05);
  EXPECT_LT(worst.angle, 2.0);
}

TEST(ExtractMesh, OnlyCoarseBricksShareVertices) {
  const SparseVolume volume = sample_volume(glm::ivec3(6), box({8, 8, 8}, {40, 40, 40}));
  std::vector<std::uint8_t> flags;
  for (int i = 0; i < 216; ++i) flags.push_back(i % 6 < 3);  // x below 24
  const TriMesh fine = extract_mesh(volume), mesh = extract_mesh(volume, flags);
  EXPECT_EQ(open_edges(mesh), 0u);
  const auto beyond = [&](const TriMesh& m, double from, double to) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < m.positions.size(); ++i) {
      const double x = m.world(i).x;
      count += x >= from && x < to ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(beyond(mesh, 24, 48), beyond(fine, 24, 48));
  EXPECT_LT(3 * beyond(mesh, 0, 23), beyond(fine, 0, 23));
}

TEST(ExtractMesh, EmptyVolumesGiveEmptyMeshes) {
  EXPECT_TRUE(
      extract_mesh(SparseVolume{{glm::dvec3(0), 1, glm::ivec3(0)}, {}, {}, {}}).positions.empty());
  const TriMesh mesh =
      extract_mesh(sample_volume(glm::ivec3(2), [](const glm::dvec3&) { return 1.0; }));
  EXPECT_TRUE(mesh.positions.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

}  // namespace
}  // namespace photohull
