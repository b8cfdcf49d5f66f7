#include "mesh/sharpen_edges.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "core/error.h"
#include "mesh/mesh_edges.h"
#include "mesh/simplify_mesh.h"
#include "raycast/closest_point.h"
#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

using glm::dvec3;

const glm::ivec3 kBricks(8);
const dvec3 kMiddle(31.6, 31.3, 31.9);

/// An odd angle: no face along the lattice.
const glm::dmat3 kTurn(glm::rotate(glm::rotate(glm::dmat4(1), 0.47, dvec3(1, 0.2, 0.1)), 0.31,
                                   dvec3(0, 1, 0.6)));

/// The greater of two distances, rounded where they differ by less than k, by k / 4 at most.
double round_max(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0);
  return std::max(a, b) + h * h / (4 * k);
}

double round_min(double a, double b, double k) { return -round_max(-a, -b, k); }

/// Of positions in the turned frame.
Distance turned(const Distance& distance) {
  return [=](const dvec3& p) { return distance(glm::transpose(kTurn) * (p - kMiddle)); };
}

/// A box around the turned frame's origin with edges rounded as reconstruction does.
Distance rounded_box(const dvec3& half, double k) {
  return [=](const dvec3& p) {
    const dvec3 q = glm::abs(p) - half;
    return round_max(round_max(q.x, q.y, k), q.z, k);
  };
}

/// Bumps as errors of reconstruction are: some voxels long.
Distance rough(const Distance& distance, double height) {
  return [=](const dvec3& p) {
    return distance(p) + height *
                             (std::sin(0.9 * p.x + 0.3 * p.y) + std::sin(1.1 * p.y - 0.4 * p.z) +
                              std::sin(0.8 * p.z + 0.5 * p.x)) /
                             1.7;
  };
}

/// The surface in voxels, positions as they are in the grid.
TriMesh mesh_of(const Distance& distance) {
  TriMesh mesh = extract_mesh(sample_volume(kBricks, distance));
  for (glm::vec3& p : mesh.positions) p += glm::vec3(mesh.origin);
  mesh.origin = dvec3(0);
  return mesh;
}

std::size_t sharpen(TriMesh& mesh, double detail = 1, const SharpenOptions& options = {}) {
  return sharpen_edges(options, 1, detail, mesh);
}

/// Points of the edges of a box of `half`, `inset` from the corners.
std::vector<dvec3> edge_points(const dvec3& half, double inset) {
  std::vector<dvec3> points;
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 4; ++corner)
      for (double along = -half[axis] + inset; along <= half[axis] - inset; along += 0.5) {
        dvec3 p;
        p[axis] = along;
        p[(axis + 1) % 3] = (corner & 1 ? 1 : -1) * half[(axis + 1) % 3];
        p[(axis + 2) % 3] = (corner & 2 ? 1 : -1) * half[(axis + 2) % 3];
        points.push_back(kMiddle + kTurn * p);
      }
  return points;
}

std::vector<dvec3> corner_points(const dvec3& half) {
  std::vector<dvec3> points;
  for (int c = 0; c < 8; ++c)
    points.push_back(kMiddle +
                     kTurn * (half * dvec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
  return points;
}

double mean_distance(const TriMesh& mesh, const std::vector<dvec3>& points) {
  const ClosestPoint surface(mesh);
  double sum = 0;
  for (const dvec3& p : points) sum += surface.nearest(p).distance;
  return sum / double(points.size());
}

/// Triangles that are degenerate, or folded onto a neighbour.
std::size_t bad_triangles(const TriMesh& mesh) {
  std::size_t bad = 0;
  const auto sides = sorted_sides(mesh.triangles);
  for (const Side& side : sides) {
    const Side* other = opposite(sides, side);
    if (other && glm::dot(unit_normal(corners(mesh, side.triangle)),
                          unit_normal(corners(mesh, other->triangle))) < kFoldCosine)
      ++bad;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    bad += relative_height(corners(mesh, t)) < kLeastHeight;
  return bad;
}

const dvec3 kHalf(21, 17, 15);

TEST(SharpenEdges, BringsBackRoundedEdgesAndCornersOfATurnedBox) {
  TriMesh mesh = mesh_of(rough(turned(rounded_box(kHalf, 1.8)), 0.02));
  const auto edges = edge_points(kHalf, 3);
  EXPECT_GT(mean_distance(mesh, edges), 0.5);
  EXPECT_GT(mean_distance(mesh, corner_points(kHalf)), 0.9);
  EXPECT_GT(sharpen(mesh), 1000u);
  EXPECT_LT(mean_distance(mesh, edges), 0.06);
  EXPECT_LT(mean_distance(mesh, corner_points(kHalf)), 0.25);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_EQ(bad_triangles(mesh), 0u);
  EXPECT_NEAR(signed_volume(mesh), 8 * kHalf.x * kHalf.y * kHalf.z, 150);
}

TEST(SharpenEdges, NormalsAreUnitAndFaceOutward) {
  TriMesh mesh = mesh_of(turned(rounded_box(kHalf, 1.8)));
  ASSERT_GT(sharpen(mesh), 0u);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    ASSERT_NEAR(glm::length(mesh.normals[i]), 1, 1e-4);
    ASSERT_GT(glm::dot(dvec3(mesh.normals[i]), mesh.world(i) - kMiddle), 0);
  }
}

TEST(SharpenEdges, BringsBackAHollowEdge) {
  // A box on a slab; an edge between them along the turned frame's y.
  const auto step = [](const dvec3& p) {
    const double slab = rounded_box({22, 18, 6}, 1.8)(p - dvec3(0, 0, -8));
    const double tower = rounded_box({10, 14, 13}, 1.8)(p - dvec3(-8, 0, 1));
    return round_min(slab, tower, 1.8);
  };
  TriMesh mesh = mesh_of(rough(turned(step), 0.02));
  std::vector<dvec3> edge;
  for (double y = -11; y <= 11; y += 0.5) edge.push_back(kMiddle + kTurn * dvec3(2, y, -2));
  EXPECT_GT(mean_distance(mesh, edge), 0.4);
  sharpen(mesh);
  EXPECT_LT(mean_distance(mesh, edge), 0.06);
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_EQ(bad_triangles(mesh), 0u);
}

TEST(SharpenEdges, LeavesSmoothAndRoughSurfacesAlone) {
  for (const double height : {0.0, 0.05, 0.2, 0.5}) {
    TriMesh mesh = mesh_of(rough(sphere(kMiddle, 24), height));
    const TriMesh before = mesh;
    EXPECT_EQ(sharpen(mesh), 0u) << height;
    EXPECT_EQ(mesh.positions, before.positions);
    EXPECT_EQ(mesh.normals, before.normals);
  }
}

TEST(SharpenEdges, LeavesWideRoundingsAlone) {
  const Distance core = box(-kHalf + 6.0, kHalf - 6.0);
  TriMesh mesh = mesh_of(turned([=](const dvec3& p) { return core(p) - 6; }));
  EXPECT_EQ(sharpen(mesh), 0u);
}

TEST(SharpenEdges, LeavesTheRimOfAThinPlateAlone) {
  TriMesh mesh = mesh_of(turned([](const dvec3& p) {
    return box({-20, -20, -0.5}, {20, 20, 0.5})(p) - 0.8;
  }));
  EXPECT_EQ(sharpen(mesh), 0u);
}

TEST(SharpenEdges, LeavesShortEdgesAlone) {
  const dvec3 half(5);
  TriMesh mesh = mesh_of(turned(rounded_box(half, 1.8)));
  SharpenOptions options;
  options.shortest = 30;
  EXPECT_EQ(sharpen(mesh, 1, options), 0u);
}

TEST(SharpenEdges, WhatIsRoundedOverSeveralVoxelsNeedsTheDetail) {
  const glm::ivec3 bricks(12);
  const dvec3 half(36, 32, 30);
  const Distance coarse = turned(rounded_box(half, 5));
  const Distance moved = [=](const dvec3& p) { return coarse(p - 16.0); };
  TriMesh mesh = extract_mesh(sample_volume(bricks, moved)), again = mesh;
  EXPECT_EQ(sharpen(mesh, 1), 0u);
  EXPECT_GT(sharpen(again, 2), 1000u);
  std::vector<dvec3> edges = edge_points(half, 8);
  for (dvec3& p : edges) p += 16.0;
  EXPECT_GT(mean_distance(mesh, edges), 1.5);
  EXPECT_LT(mean_distance(again, edges), 0.1);
}

TEST(SharpenEdges, SimplificationKeepsTheEdges) {
  TriMesh mesh = mesh_of(rough(turned(rounded_box(kHalf, 1.8)), 0.02));
  sharpen(mesh);
  const TriMesh simple = simplify_mesh(mesh, 0.25);
  EXPECT_LT(simple.triangles.size(), mesh.triangles.size() / 5);
  EXPECT_LT(mean_distance(simple, edge_points(kHalf, 3)), 0.12);
}

TEST(SharpenEdges, TheNumberOfThreadsDoesNotMatter) {
  const Distance distance = rough(turned(rounded_box(kHalf, 1.8)), 0.03);
  TriMesh many = mesh_of(distance), one = many;
  sharpen(many);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  sharpen(one);
  EXPECT_EQ(many.positions, one.positions);
  EXPECT_EQ(many.normals, one.normals);
}

TEST(SharpenEdges, OffAndEmptyDoNothing) {
  TriMesh mesh = mesh_of(turned(rounded_box(kHalf, 1.8)));
  SharpenOptions off;
  off.on = false;
  EXPECT_EQ(sharpen(mesh, 1, off), 0u);
  TriMesh empty;
  EXPECT_EQ(sharpen(empty), 0u);
}

TEST(SharpenEdges, OptionsAreChecked) {
  const auto refuses = [](auto change) {
    SharpenOptions options;
    change(options);
    EXPECT_THROW(options.validate(), UsageError);
  };
  refuses([](SharpenOptions& o) { o.bend = 0; });
  refuses([](SharpenOptions& o) { o.reach = 1; });
  refuses([](SharpenOptions& o) { o.distinct = -1; });
  refuses([](SharpenOptions& o) { o.rounding = NAN; });
  refuses([](SharpenOptions& o) { o.shortest = -1; });
}

}  // namespace
}  // namespace photohull
