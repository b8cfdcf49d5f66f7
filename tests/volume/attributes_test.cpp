#include "volume/attributes.h"

#include <gtest/gtest.h>

#include "analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

/// Colour and confidence are linear in the world position: interpolation reproduces them.
glm::vec3 colour_at(const glm::dvec3& p) { return glm::vec3(p / 64.0); }
float confidence_at(const glm::dvec3& p) { return float(1 - p.x / 64); }

TriMesh painted(TriMesh mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.colours.push_back(colour_at(mesh.world(i)));
    mesh.confidence.push_back(confidence_at(mesh.world(i)));
  }
  return mesh;
}

constexpr double kTolerance = 3.0 / 64;  // what the colour changes over 3 voxels

/// Every stored voxel near the surface knows the value there but for the distance from the surface
/// and the spread, the others know nothing.
void expect_painted(const SparseVolume& volume, const VolumeAttributes& attributes) {
  ASSERT_EQ(attributes.colour.size(), volume.distance.size());
  ASSERT_EQ(attributes.confidence.size(), volume.distance.size());
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot)
    for (int i = 0; i < kBrickVoxels; ++i) {
      const std::size_t index = slot * kBrickVoxels + i;
      const glm::dvec3 p(volume.bricks[slot] * kBrickEdge +
                         glm::ivec3(i >> 6, (i >> 3) & 7, i & 7));
      if (std::abs(volume.distance[index]) < VolumeAttributes::kReach) {
        ASSERT_LT(glm::distance(attributes.colour[index], colour_at(p)), kTolerance);
        ASSERT_NEAR(attributes.confidence[index], confidence_at(p), kTolerance);
      } else {
        ASSERT_EQ(attributes.colour[index].r, VolumeAttributes::kUnknown);
        ASSERT_EQ(attributes.confidence[index], VolumeAttributes::kUnknown);
      }
    }
}

TEST(Attributes, FollowTheMesh) {
  const SparseVolume volume = sample_volume(glm::ivec3(8), sphere({31.3, 32.1, 30.7}, 20));
  expect_painted(volume, attributes_from_mesh(volume, painted(extract_mesh(volume))));
}

TEST(Attributes, FollowLargeTriangles) {
  const SparseVolume volume = sample_volume(glm::ivec3(8), box({10, 10, 10}, {50, 51, 52}));
  const TriMesh mesh = extract_mesh(volume, 0.5);
  ASSERT_LT(mesh.positions.size(), 2000u);
  expect_painted(volume, attributes_from_mesh(volume, painted(mesh)));
}

TEST(Attributes, OfAMeshWithoutAny) {
  const SparseVolume volume = sample_volume(glm::ivec3(2), sphere(glm::dvec3(8), 5));
  TriMesh mesh = extract_mesh(volume);
  const VolumeAttributes none = attributes_from_mesh(volume, mesh);
  EXPECT_TRUE(none.colour.empty() && none.confidence.empty());
  mesh.confidence.assign(mesh.positions.size(), 0.5f);
  const VolumeAttributes some = attributes_from_mesh(volume, mesh);
  EXPECT_TRUE(some.colour.empty());
  EXPECT_EQ(some.confidence.size(), volume.distance.size());
}

}  // namespace
}  // namespace photohull
