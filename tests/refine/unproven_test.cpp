// Hollows under the hull that no match supports.
#include "refine/unproven.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::ivec3;

const ivec3 kBricks(6, 6, 6);
const dvec3 kMiddle(23.5, 23.5, 23.5);
constexpr double kRadius = 16;

double ball(const dvec3& p) { return glm::distance(p, kMiddle) - kRadius; }

/// The ball with a round pit of this depth at its top.
double pitted(const dvec3& p, double depth) {
  const dvec3 at = kMiddle + dvec3(0, 0, kRadius);
  return std::max(ball(p), depth - glm::distance(p, at));
}

struct Scene {
  SparseVolume hull, volume;
  std::vector<glm::vec3> positions, normals;
  std::vector<float> weights;
};

/// A pit whose surface, as all of the mesh, has peaks of this weight; below 0: unseen in the pit.
Scene pit(double depth, float in_pit, float elsewhere = 1) {
  Scene s;
  s.hull = sample_volume(kBricks, ball);
  s.volume = sample_volume(kBricks, [&](const dvec3& p) { return pitted(p, depth); });
  const TriMesh mesh = extract_mesh(s.volume);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 voxel = (mesh.world(i) - s.hull.grid.origin) / s.hull.grid.voxel_size;
    s.positions.emplace_back(voxel);
    s.normals.push_back(mesh.normals[i]);
    s.weights.push_back(ball(voxel) < -0.6 ? in_pit : elsewhere);
  }
  return s;
}

std::size_t fill(Scene& s, const UnprovenOptions& options = {}) {
  return fill_unproven(s.hull, s.positions, s.normals, s.weights, options, s.volume);
}

TEST(FillUnproven, APitWithoutMatchesGoes) {
  for (const double depth : {3.0, 5.0}) {
    Scene s = pit(depth, 0.02f);
    const std::size_t lacking = s.hull.inside_voxels() - s.volume.inside_voxels();
    EXPECT_GT(fill(s), lacking / 2);
    // What is left is the shell that counts as the hull's own surface.
    EXPECT_GT(s.volume.inside_voxels() + lacking / 20, s.hull.inside_voxels()) << depth;
    EXPECT_LE(s.volume.inside_voxels(), s.hull.inside_voxels());
  }
}

TEST(FillUnproven, AHollowThatMatchesSupportStays) {
  Scene s = pit(5, 0.5f);
  const SparseVolume before = s.volume;
  EXPECT_EQ(fill(s), 0u);
  EXPECT_EQ(s.volume.distance, before.distance);
}

TEST(FillUnproven, WhatNoViewSeesIsLeftToOthers) {
  Scene s = pit(5, -1);
  EXPECT_EQ(fill(s), 0u);
}

TEST(FillUnproven, OneHollowDoesNotSpeakForAnother) {
  Scene s = pit(5, 0.9f);
  // A second pit, without matches, at the other end.
  const auto body = [](const dvec3& p) {
    return std::max(pitted(p, 5), 5 - glm::distance(p, kMiddle - dvec3(0, 0, kRadius)));
  };
  s.volume = sample_volume(kBricks, body);
  const TriMesh mesh = extract_mesh(s.volume);
  s.positions.clear(), s.normals.clear(), s.weights.clear();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 voxel = (mesh.world(i) - s.hull.grid.origin) / s.hull.grid.voxel_size;
    s.positions.emplace_back(voxel);
    s.normals.push_back(mesh.normals[i]);
    s.weights.push_back(voxel.z > kMiddle.z ? 0.9f : 0.01f);
  }
  EXPECT_GT(fill(s), 0u);
  EXPECT_GT(s.volume.interpolated(kMiddle + dvec3(0, 0, kRadius - 2)), 0);
  EXPECT_LT(s.volume.interpolated(kMiddle - dvec3(0, 0, kRadius - 2)), 0);
}

TEST(FillUnproven, CanBeSwitchedOff) {
  Scene s = pit(5, 0);
  UnprovenOptions off;
  off.least_weight = 0;
  EXPECT_EQ(fill(s, off), 0u);
}

}  // namespace
}  // namespace photohull::refine
