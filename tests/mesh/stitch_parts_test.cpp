#include "mesh/stitch_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/join_meshes.h"
#include "mesh/simplify_mesh.h"
#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

constexpr double kRadius = 14;
const glm::dvec3 kCentre(19.3, 20.1, 18.7);

TriMesh ball() { return extract_mesh(sample_volume({5, 5, 5}, sphere(kCentre, kRadius))); }

/// In which of `count` parts, cut across x and y, a place lies.
int part_of(const glm::dvec3& p, int count) {
  const int x = p.x < kCentre.x + 0.2, y = p.y < kCentre.y - 3.1;
  return count == 2 ? x : 2 * x + y;
}

/// The ball's triangles by their middles, once for each part, where each has places of its own that
/// are off by up to `off` voxels.
std::vector<TriMesh> parts_of(const TriMesh& whole, int count, double off) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> noise(float(-off), float(off));
  std::vector<TriMesh> parts(std::size_t(count), whole);
  for (int part = 0; part < count; ++part) {
    TriMesh& mesh = parts[std::size_t(part)];
    mesh.colours.assign(mesh.positions.size(), glm::vec3(float(part)));
    mesh.origin += glm::dvec3(part, 0, 0);  // the same places
    for (glm::vec3& p : mesh.positions)
      p += glm::vec3(noise(random) - float(part), noise(random), noise(random));
    std::erase_if(mesh.triangles, [&](const auto& t) {
      return part_of((mesh.world(t[0]) + mesh.world(t[1]) + mesh.world(t[2])) / 3.0, count) != part;
    });
    keep_used_vertices(mesh);
  }
  return parts;
}

double volume_of(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += glm::dot(mesh.world(a) - kCentre,
                    glm::cross(mesh.world(b) - kCentre, mesh.world(c) - kCentre)) /
           6;
  return sum;
}

struct Joined {
  TriMesh mesh;
  std::size_t seam_vertices = 0, filled = 0, open_edges = 0;
};

/// What a caller makes of it, who has one part at a time.
Joined stitch_parts(const std::vector<TriMesh>& parts, double reach) {
  std::vector<Rim> rims;
  for (const TriMesh& part : parts) rims.push_back(rim_of(part));
  const Stitched stitched = stitch_rims(std::move(rims), reach);
  Joined out{{}, stitched.seam_vertices, stitched.filled, stitched.open_edges};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    TriMesh mesh = joined_part(stitched.parts[i], parts[i]);
    triangles.insert(triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
    mesh.triangles.clear();
    append_mesh(mesh, out.mesh);
  }
  triangles.insert(triangles.end(), stitched.rim.begin(), stitched.rim.end());
  out.mesh.triangles = std::move(triangles);
  EXPECT_EQ(out.mesh.positions.size(), stitched.vertices);
  EXPECT_TRUE(out.mesh.colours.empty() || out.mesh.colours.size() == stitched.vertices);
  EXPECT_EQ(out.mesh.triangles.size(), stitched.triangles);
  return out;
}

TEST(StitchParts, ExactPartsBecomeTheWhole) {
  const TriMesh whole = ball();
  for (const int count : {2, 4}) {
    const Joined stitched = stitch_parts(parts_of(whole, count, 0), 0.75);
    EXPECT_EQ(stitched.mesh.positions.size(), whole.positions.size());
    EXPECT_EQ(stitched.mesh.triangles.size(), whole.triangles.size());
    EXPECT_EQ(stitched.filled, 0u);
    EXPECT_EQ(stitched.open_edges, 0u);
    EXPECT_GT(stitched.seam_vertices, 60u);
    EXPECT_EQ(open_edges(stitched.mesh), 0u);
  }
}

TEST(StitchParts, PartsThatDifferAtTheirBordersAreClosed) {
  const TriMesh whole = ball();
  // Triangles whose middles move across the border come twice or not at all.
  for (const double off : {0.02, 0.1, 0.2}) {
    const Joined stitched = stitch_parts(parts_of(whole, 4, off), 0.75);
    EXPECT_EQ(stitched.open_edges, 0u) << off;
    EXPECT_EQ(open_edges(stitched.mesh), 0u) << off;
    EXPECT_NEAR(volume_of(stitched.mesh), volume_of(whole), 0.01 * volume_of(whole));
    for (std::size_t v = 0; v < stitched.mesh.positions.size(); ++v)
      EXPECT_NEAR(glm::distance(stitched.mesh.world(v), kCentre), kRadius, 0.3 + 2 * off);
  }
}

TEST(StitchParts, LongGapsBetweenPartsAreFilledFromSideToSide) {
  // One part ends up to two voxels before the other begins, on half of the way around.
  const TriMesh whole = ball();
  std::vector<TriMesh> parts = parts_of(whole, 2, 0.05);
  std::erase_if(parts[0].triangles, [&](const auto& t) {
    const glm::dvec3 p = parts[0].world(t[0]);
    return p.y > kCentre.y && p.x < kCentre.x + 2.2;
  });
  keep_used_vertices(parts[0]);
  const Joined stitched = stitch_parts(parts, 0.75);
  EXPECT_EQ(stitched.open_edges, 0u);
  EXPECT_EQ(open_edges(stitched.mesh), 0u);
  EXPECT_NEAR(volume_of(stitched.mesh), volume_of(whole), 0.01 * volume_of(whole));
  for (const auto& [a, b, c] : stitched.mesh.triangles)
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      EXPECT_LT(glm::distance(stitched.mesh.positions[p], stitched.mesh.positions[q]), 4);
}

TEST(StitchParts, TheSeamIsInTheMiddleAndHasBothColours) {
  const Joined stitched = stitch_parts(parts_of(ball(), 2, 0), 0.75);
  std::size_t mixed = 0;
  for (const glm::vec3& colour : stitched.mesh.colours) {
    EXPECT_TRUE(colour.r == 0 || colour.r == 0.5f || colour.r == 1) << colour.r;
    mixed += colour.r == 0.5f;
  }
  EXPECT_EQ(mixed, stitched.seam_vertices);
}

TEST(StitchParts, BordersThatAreNoSeamStay) {
  std::vector<TriMesh> parts = parts_of(ball(), 2, 0);
  // A hole in the middle of a part, and one that is a part's other end.
  const auto drop = [](TriMesh& mesh, const glm::dvec3& middle, double radius) {
    std::erase_if(mesh.triangles,
                  [&](const auto& t) { return glm::distance(mesh.world(t[0]), middle) < radius; });
    keep_used_vertices(mesh);
  };
  drop(parts[0], kCentre + glm::dvec3(kRadius, 0, 0), 2);
  drop(parts[1], kCentre - glm::dvec3(kRadius, 0, 0), 6);
  const Joined stitched = stitch_parts(parts, 0.75);
  EXPECT_EQ(stitched.open_edges, 0u);
  EXPECT_GT(open_edges(stitched.mesh), 20u);
  EXPECT_EQ(stitched.filled, 0u);
}

TEST(StitchParts, WhatOnePartAloneHasAtItsBorderGoes) {
  const glm::dvec3 at(kCentre.x + 0.2, kCentre.y + 17, kCentre.z);
  for (const double radius : {1.3, 4.0}) {
    const auto apart = [&](const glm::dvec3& p) {
      return std::min(sphere(kCentre, kRadius)(p), sphere(at, radius)(p));
    };
    const TriMesh both = extract_mesh(sample_volume({5, 6, 5}, apart));
    std::vector<TriMesh> parts = parts_of(both, 2, 0), without = parts_of(ball(), 2, 0);
    const Joined stitched = stitch_parts({parts[0], without[1]}, 0.75);
    if (radius > 2)
      EXPECT_GT(open_edges(stitched.mesh), 10u) << "a large piece is no dust";
    else
      EXPECT_EQ(stitched.mesh.triangles.size(), ball().triangles.size());
    EXPECT_EQ(open_edges(stitch_parts(parts, 0.75).mesh), 0u);
    EXPECT_EQ(stitch_parts(parts, 0.75).mesh.triangles.size(), both.triangles.size())
        << "what both have stays";
  }
}

TEST(StitchParts, NarrowOpenStripsStay) {
  // All of its triangles are near its border.
  TriMesh strip;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 2; ++j) strip.positions.emplace_back(float(i), float(j), 0.0f);
  for (std::uint32_t i = 0; i < 78; i += 2)
    strip.triangles.push_back({i, i + 2, i + 1}), strip.triangles.push_back({i + 1, i + 2, i + 3});
  EXPECT_EQ(stitch_parts({strip, ball()}, 0.75).mesh.triangles.size(),
            strip.triangles.size() + ball().triangles.size());
}

TEST(StitchParts, EmptyPartsAndFarOnesChangeNothing) {
  const TriMesh whole = ball();
  const Joined alone = stitch_parts({{}, whole, {}}, 0.75);
  EXPECT_EQ(alone.mesh.triangles, whole.triangles) << "a closed part has no rim";
  EXPECT_EQ(alone.seam_vertices, 0u);
  TriMesh far = whole;
  far.origin += glm::dvec3(100, 0, 0);
  EXPECT_EQ(open_edges(stitch_parts({whole, far}, 0.75).mesh), 0u);
  EXPECT_TRUE(stitch_parts({}, 0.75).mesh.positions.empty());
}

}  // namespace
}  // namespace photohull
