#include "eval/signed_distance.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "eval/topology.h"
#include "shapes.h"

namespace photohull::eval {
namespace {

/// Each triangle with corners of its own.
TriMesh torn(const TriMesh& mesh) {
  TriMesh result;
  result.origin = mesh.origin;
  for (const auto& triangle : mesh.triangles) {
    const auto first = std::uint32_t(result.positions.size());
    for (const std::uint32_t v : triangle) result.positions.push_back(mesh.positions[v]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

double box_distance(const glm::dvec3& p, const glm::dvec3& half) {
  const glm::dvec3 q = glm::abs(p) - half;
  return glm::length(glm::max(q, glm::dvec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

TEST(SignedDistance, ExactAroundABoxAtItsEdgesAndCornersToo) {
  const glm::dvec3 half(1, 0.5, 0.25);
  const TriMesh mesh = test::box(-half, half);
  std::mt19937 random(1);
  std::uniform_real_distribution<> number(-2, 2);
  for (const TriMesh& given : {mesh, torn(mesh)}) {
    const SignedDistance surface(given);
    for (int i = 0; i < 20000; ++i) {
      const glm::dvec3 p(number(random), number(random), number(random));
      ASSERT_NEAR(surface.at(p).distance, box_distance(p, half), 1e-9);
    }
    EXPECT_NEAR(glm::dot(surface.at({3, 2, 1}).normal, glm::normalize(glm::dvec3(1))), 1, 1e-6);
    EXPECT_NEAR(glm::dot(surface.at({0, 2, 1}).normal, glm::normalize(glm::dvec3(0, 1, 1))), 1,
                1e-6);
  }
}

TEST(SignedDistance, SignAtASharpTipNeedsThePseudonormal) {
  // Beyond the tip of a thin needle, points lie behind the planes of some of its faces.
  TriMesh needle;
  needle.positions = {{0, 0, 10}, {-1, -1, 0}, {1, -1, 0}, {0.8f, 1, 0}};
  needle.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const SignedDistance surface(needle);
  EXPECT_LT(surface.at({0, 0, 2}).distance, 0);
  std::mt19937 random(2);
  std::uniform_real_distribution<> number(-0.5, 0.5);
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 p(number(random), number(random), 10.05 + std::abs(number(random)));
    ASSERT_GT(surface.at(p).distance, 0);
  }
}

TEST(SignedDistance, FacesWithoutAreaAreNoSurface) {
  TriMesh mesh = test::plate(0, 0, 0, 1, 1);
  mesh.positions.emplace_back(0, 0, 5);
  mesh.triangles.push_back({0, 4, 4});
  EXPECT_NEAR(SignedDistance(mesh).at({0.5, 0.5, 4}).distance, 4, 1e-12);
  mesh.triangles = {{0, 1, 1}};
  EXPECT_THROW(SignedDistance{mesh}, Error);
}

}  // namespace
}  // namespace photohull::eval
