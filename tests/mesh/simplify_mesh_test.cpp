#include "mesh/simplify_mesh.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.h"
#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

const glm::dvec3 kCenter(31.3, 32.1, 30.7);  // off the lattice

TriMesh surface_of(const Distance& distance, double voxel = 1, int bricks = 8) {
  return extract_mesh(
      sample_volume(glm::ivec3(bricks), distance, glm::dvec3(3, -2, 5) * voxel, voxel));
}

/// Triangles lower than a fiftieth of their longest side.
double sliver_share(const TriMesh& mesh) {
  std::size_t slivers = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 p(mesh.positions[a]), q(mesh.positions[b]), r(mesh.positions[c]);
    const double longest =
        std::max({glm::distance(p, q), glm::distance(q, r), glm::distance(r, p)});
    slivers += glm::length(glm::cross(q - p, r - p)) < 0.02 * longest * longest;
  }
  return double(slivers) / double(mesh.triangles.size());
}

/// Smallest dot product of neighbours' normals.
double sharpest_cosine(const TriMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, glm::dvec3> normals;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 p = mesh.world(t[0]);
    const glm::dvec3 n = glm::normalize(glm::cross(mesh.world(t[1]) - p, mesh.world(t[2]) - p));
    for (int i = 0; i < 3; ++i) normals[{t[i], t[(i + 1) % 3]}] = n;
  }
  double least = 1;
  for (const auto& [edge, normal] : normals)
    least = std::min(least, glm::dot(normal, normals.at({edge.second, edge.first})));
  return least;
}

struct Body {
  const char* name;
  Distance distance;
  double largest_share;    ///< of the triangles, at a quarter of a voxel
  double largest_slivers;  ///< share of what is left
};

std::vector<Body> bodies() {
  return {{"sphere", sphere(kCenter, 24), 0.15, 0.002},
          {"torus", torus(kCenter, 18, 7), 0.2, 0.002},
          {"box", box({8.2, 10.3, 9.1}, {52.4, 47.7, 50.2}), 0.02, 0.03}};
}

TEST(SimplifyMesh, StaysWithinTheErrorAtAnyScale) {
  for (const double voxel : {1e-3, 250.0})
    for (const Body& body : bodies())
      for (const double error : {0.05, 0.25, 1.0}) {
        if (voxel != 250 && error != 0.25) continue;
        SCOPED_TRACE(std::string(body.name) + " " + std::to_string(voxel) + " " +
                     std::to_string(error));
        const TriMesh mesh = surface_of(body.distance, voxel);
        const TriMesh simple = simplify_mesh(mesh, error * voxel);
        EXPECT_EQ(open_edges(simple), 0u);
        EXPECT_GT(smallest_area(simple), 0.0);
        // Measured more densely than the simplification does.
        const MeshDistance distance = measure_distance(mesh, simple, 0.3 * voxel);
        EXPECT_LE(distance.max, error * voxel);
        // Most of the surface is much nearer, and as much of it without as within.
        EXPECT_LT(distance.mean, 0.1 * error * voxel);
        EXPECT_LT(distance.p95, 0.25 * error * voxel);
        EXPECT_GT(distance.max, 0.0);
        EXPECT_NEAR(signed_volume(simple) / signed_volume(mesh), 1, 0.01 * error);
        EXPECT_LT(simple.triangles.size(), mesh.triangles.size());
        if (error == 0.25) {
          EXPECT_LT(double(simple.triangles.size()),
                    body.largest_share * double(mesh.triangles.size()));
          EXPECT_LT(sliver_share(simple), body.largest_slivers);
        }
      }
}

TEST(SimplifyMesh, ThinAndSharpBodiesNeedFewTrianglesAndDoNotFold) {
  // A sheet of two voxels, and a wedge of 15 degrees.
  const Distance slab = box({8.2, 10.3, 30.1}, {52.4, 47.7, 32.3});
  const Distance wedge = [](const glm::dvec3& p) {
    const double up = std::abs(p.z - 31.3), in = p.x - 8.4;
    return std::max({std::cos(0.13) * up - std::sin(0.13) * in, p.x - 50.6, 9.7 - p.y, p.y - 49.2});
  };
  for (const Distance& body : {slab, wedge}) {
    const TriMesh mesh = surface_of(body);
    const TriMesh simple = simplify_mesh(mesh, 0.5);
    EXPECT_LT(simple.triangles.size(), mesh.triangles.size() / 10);
    EXPECT_EQ(open_edges(simple), 0u);
    EXPECT_GT(smallest_area(simple), 0.0);
    EXPECT_LE(measure_distance(mesh, simple, 0.3).max, 0.5);
    EXPECT_GE(sharpest_cosine(simple), std::min(-0.5, sharpest_cosine(mesh)));
  }
}

TEST(SimplifyMesh, LargerErrorsLeaveFewerTriangles) {
  const TriMesh mesh = surface_of(torus(kCenter, 18, 7));
  std::size_t before = mesh.triangles.size();
  for (const double error : {0.02, 0.1, 0.4, 1.0}) {
    const std::size_t left = simplify_mesh(mesh, error).triangles.size();
    EXPECT_LT(left, before) << error;
    before = left;
  }
}

TEST(SimplifyMesh, BlocksOfALargeMeshFitTogether) {
  // Two blocks and more along each axis.
  const TriMesh mesh = surface_of(sphere(glm::dvec3(48.3, 47.8, 46.9), 43), 1, 12);
  const TriMesh simple = simplify_mesh(mesh, 0.25);
  EXPECT_EQ(open_edges(simple), 0u);
  EXPECT_LE(measure_distance(mesh, simple, 0.5).max, 0.25);
  EXPECT_LT(simple.triangles.size(), mesh.triangles.size() / 10);
}

TEST(SimplifyMesh, VerticesKeepTheirAttributesAndOrder) {
  TriMesh mesh = surface_of(sphere(kCenter, 20));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.colours.push_back(mesh.positions[i] * 0.01f);
    mesh.confidence.push_back(mesh.positions[i].x);
  }
  const TriMesh simple = simplify_mesh(mesh, 0.25);
  ASSERT_EQ(simple.normals.size(), simple.positions.size());
  ASSERT_EQ(simple.colours.size(), simple.positions.size());
  ASSERT_EQ(simple.confidence.size(), simple.positions.size());
  EXPECT_EQ(simple.origin, mesh.origin);
  std::size_t before = 0;
  for (std::size_t i = 0; i < simple.positions.size(); ++i) {
    while (before < mesh.positions.size() && mesh.colours[before] != simple.colours[i]) ++before;
    ASSERT_LT(before, mesh.positions.size());
    EXPECT_LE(glm::distance(simple.positions[i], mesh.positions[before]), 0.25);
    EXPECT_EQ(simple.normals[i], mesh.normals[before]);
    EXPECT_EQ(simple.confidence[i], mesh.confidence[before]);
    const glm::dvec3 outward = simple.world(i) - glm::dvec3(3, -2, 5) - kCenter;
    EXPECT_GT(glm::dot(glm::dvec3(simple.normals[i]), glm::normalize(outward)), 0.99);
  }
  for (const auto& triangle : simple.triangles)
    for (const std::uint32_t v : triangle) ASSERT_LT(v, simple.positions.size());
}

TEST(SimplifyMesh, TwoBodiesStayTwo) {
  const Distance first = sphere({18, 20, 20}, 12), second = sphere({44, 42, 40}, 14);
  const TriMesh mesh =
      surface_of([&](const glm::dvec3& p) { return std::min(first(p), second(p)); });
  const TriMesh simple = simplify_mesh(mesh, 0.25);
  EXPECT_EQ(open_edges(simple), 0u);
  // Euler: vertices less half the faces is 2 for each closed body without handles.
  EXPECT_EQ(simple.positions.size() - simple.triangles.size() / 2, 4u);
  EXPECT_LE(measure_distance(mesh, simple, 0.5).max, 0.25);
}

TEST(SimplifyMesh, BordersStay) {
  TriMesh mesh = surface_of(sphere(kCenter, 20));
  std::erase_if(mesh.triangles,
                [&](const auto& t) { return mesh.positions[t[0]].z > mesh.positions[0].z; });
  const auto border = [](const TriMesh& m) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : m.triangles)
      for (int i = 0; i < 3; ++i) ++edges[std::minmax(t[i], t[(i + 1) % 3])];
    double length = 0;
    for (const auto& [edge, uses] : edges)
      if (uses == 1) length += glm::distance(m.positions[edge.first], m.positions[edge.second]);
    return length;
  };
  const double before = border(mesh);
  ASSERT_GT(before, 1.0);
  const TriMesh simple = simplify_mesh(mesh, 0.5);
  EXPECT_LT(simple.triangles.size(), mesh.triangles.size() / 2);
  EXPECT_NEAR(border(simple), before, 1e-3);
}

TEST(SimplifyMesh, SameWithAnyOrderOfThreads) {
  const TriMesh mesh = surface_of(torus(kCenter, 18, 7));
  const TriMesh first = simplify_mesh(mesh, 0.25);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const TriMesh second = simplify_mesh(mesh, 0.25);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.positions, second.positions);
}

TEST(SimplifyMesh, NothingToDo) {
  const TriMesh mesh = surface_of(sphere(kCenter, 10));
  const TriMesh same = simplify_mesh(mesh, 0);
  EXPECT_EQ(same.triangles, mesh.triangles);
  EXPECT_EQ(same.positions, mesh.positions);
  EXPECT_TRUE(simplify_mesh(TriMesh(), 1).triangles.empty());
}

TEST(SimplifyMesh, RejectsBadErrors) {
  const TriMesh mesh = surface_of(sphere(kCenter, 10));
  for (const double error : {-0.1, double(NAN), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(simplify_mesh(mesh, error), UsageError) << error;
}

TEST(MeasureDistance, OfConcentricSpheres) {
  const TriMesh small = surface_of(sphere(kCenter, 18)), large = surface_of(sphere(kCenter, 20));
  const MeshDistance distance = measure_distance(small, large, 1);
  EXPECT_NEAR(distance.mean, 2, 0.05);
  EXPECT_NEAR(distance.p95, 2, 0.1);
  EXPECT_NEAR(distance.max, 2, 0.2);
  EXPECT_LE(distance.p95, distance.p999);
  EXPECT_LE(distance.p999, distance.max);
  EXPECT_LT(measure_distance(small, small, 1).max, 1e-9);
}

// Everything of such a body may collapse, which is no surface near to it any more.
TEST(SimplifyMesh, BodiesSmallerThanTheErrorStay) {
  for (const double radius : {0.6, 0.9, 1.5, 3.0})
    for (const double error : {0.25, 1.0, 4.0, 100.0}) {
      const TriMesh mesh = surface_of(sphere(kCenter, radius));
      EXPECT_FALSE(simplify_mesh(mesh, error).triangles.empty()) << radius << " " << error;
    }
}

}  // namespace
}  // namespace photohull
