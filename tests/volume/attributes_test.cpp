#include "volume/attributes.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"
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

constexpr double kTolerance = 3.5 / 64;  // a splat and a fill reach at most 2 sqrt(3) voxels

/// Checks that the voxels near the surface know the value there but for the spread, and that the
/// others know nothing. Returns how many near the surface know nothing either.
std::size_t count_unknown(const SparseVolume& volume, const VolumeAttributes& attributes) {
  EXPECT_EQ(attributes.colour.size(), volume.distance.size());
  EXPECT_EQ(attributes.confidence.size(), volume.distance.size());
  std::size_t unknown = 0;
  for (std::size_t index = 0; index < volume.distance.size(); ++index) {
    const glm::vec3 colour = attributes.colour[index];
    const float confidence = attributes.confidence[index];
    const bool near = std::abs(volume.distance[index]) < VolumeAttributes::kReach;
    EXPECT_EQ(colour.r == VolumeAttributes::kUnknown, confidence == VolumeAttributes::kUnknown);
    if (confidence == VolumeAttributes::kUnknown) {
      unknown += near;
      continue;
    }
    const int i = int(index % kBrickVoxels);
    const glm::dvec3 p(volume.bricks[index / kBrickVoxels] * kBrickEdge +
                       glm::ivec3(i >> 6, (i >> 3) & 7, i & 7));
    EXPECT_TRUE(near);
    EXPECT_LT(glm::distance(colour, colour_at(p)), kTolerance);
    EXPECT_NEAR(confidence, confidence_at(p), kTolerance);
  }
  return unknown;
}

TEST(Attributes, FollowTheMesh) {
  const SparseVolume volume = sample_volume(glm::ivec3(8), sphere({31.3, 32.1, 30.7}, 20));
  const TriMesh mesh = painted(extract_mesh(volume));
  EXPECT_EQ(count_unknown(volume, attributes_from_mesh(volume, mesh)), 0u);
}

TEST(Attributes, FollowLargeTriangles) {
  const SparseVolume volume = sample_volume(glm::ivec3(8), box({10, 10, 10}, {50, 51, 52}));
  const TriMesh mesh = painted(extract_mesh(volume, std::vector<std::uint8_t>(512, 1)));
  ASSERT_LT(mesh.positions.size(), 2000u);
  // The coarse mesh passes the box's edges by: some voxels there have no mesh near them.
  EXPECT_LT(count_unknown(volume, attributes_from_mesh(volume, mesh)),
            volume.distance.size() / 500);
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
