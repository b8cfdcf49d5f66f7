// Similarities found anew between shapes that were moved by known ones.
#include "eval/align.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/error.h"
#include "eval/evaluate.h"
#include "shapes.h"

namespace photohull::eval {
namespace {

/// No turn takes it onto itself: a table with a box on one corner and a ball.
TriMesh shape() {
  TriMesh mesh = test::box({-2, -1.5, 0}, {2, 1.5, 0.4});
  mesh = test::together(mesh, test::box({-1.8, -1.2, 0.4}, {-0.6, -0.4, 2.2}));
  return test::together(mesh, test::sphere({1.2, 0.6, 1}, 0.6, 4));
}

Alignment similarity(double scale, double degrees, const glm::dvec3& axis,
                     const glm::dvec3& shift) {
  return {scale, glm::mat3_cast(glm::angleAxis(glm::radians(degrees), glm::normalize(axis))),
          shift};
}

/// The largest distance by which the found similarity takes vertices off, of the diagonal.
double error(const TriMesh& mesh, const TriMesh& given, const Alignment& found, double diagonal) {
  double most = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    most = std::max(most, glm::distance(mesh.world(i), found(given.world(i))));
  return most / diagonal;
}

TEST(Align, KnownSimilaritiesAreFoundAgain) {
  const TriMesh mesh = shape();
  const Truth truth{TriMesh(mesh)};
  Progress silent;
  for (const Alignment& away :
       {similarity(1, 0, {0, 0, 1}, {0, 0, 0}), similarity(1.003, 0.5, {1, 0, 2}, {0.01, 0, 0.02}),
        similarity(1000, 100, {1, 2, 3}, {-5e4, 3e4, 7e3}),
        similarity(0.01, 180, {0, 1, 0}, {1, 2, 3}),
        similarity(3, 140, {-3, 1, 0.5}, {0, -9, 0})}) {
    const TriMesh given = moved(mesh, away);
    const Alignment found = align(given, truth, 1, silent);
    EXPECT_LT(error(mesh, given, found, truth.diagonal()), 1e-5) << away.scale;
    EXPECT_NEAR(found.scale * away.scale, 1, 1e-5);
    EXPECT_NEAR(
        found.degrees,
        away.scale == 1
            ? 0
            : glm::degrees(std::acos(
                  (away.rotation[0][0] + away.rotation[1][1] + away.rotation[2][2] - 1) / 2)),
        0.05);
    EXPECT_LT(found.rms, 1e-5 * truth.diagonal());
  }
}

TEST(Align, PointsAndIncompleteResultsAreAligned) {
  const TriMesh mesh = shape();
  TriMesh cloud;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {  // points of all faces
    const auto& [a, b, c] = mesh.triangles[t];
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; i + j <= 40 && t < 24; ++j)
        cloud.positions.push_back(glm::vec3((double(i) * mesh.world(a) + double(j) * mesh.world(b) +
                                             double(40 - i - j) * mesh.world(c)) /
                                            40.0));
    if (t >= 24)
      cloud.positions.push_back(glm::vec3((mesh.world(a) + mesh.world(b) + mesh.world(c)) / 3.0));
  }
  const Truth truth(cloud);
  ASSERT_TRUE(truth.is_points());
  TriMesh part = mesh;  // without half of the ball
  std::erase_if(part.triangles,
                [&](const auto& t) { return mesh.world(t[0]).x > 1.3 && t[0] >= 16; });
  const Alignment away = similarity(20, 75, {1, -1, 0.3}, {100, 0, 0});
  const TriMesh given = moved(part, away);
  Progress silent;
  const Alignment found = align(given, truth, 1, silent);
  EXPECT_LT(error(part, given, found, truth.diagonal()), 5e-3);
}

TEST(Align, TheSameForAnyNumberOfThreadsAndNoOtherForOtherSeeds) {
  const TriMesh mesh = shape();
  const Truth truth{TriMesh(mesh)};
  const TriMesh given = moved(mesh, similarity(2, 60, {1, 2, 0}, {1, 0, 0}));
  Progress silent;
  const Alignment a = align(given, truth, 1, silent);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Alignment b = align(given, truth, 1, silent);
  EXPECT_EQ(a.scale, b.scale);
  EXPECT_EQ(a.rotation, b.rotation);
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_NEAR(align(given, truth, 2, silent).scale, 0.5, 1e-4);
}

TEST(Align, NormalsTurnWithTheMesh) {
  TriMesh mesh = test::plate(0, 0, 0, 1, 1);
  mesh.normals.assign(4, glm::vec3(0, 0, 1));
  const TriMesh turned = moved(mesh, similarity(5, 90, {1, 0, 0}, {1, 2, 3}));
  EXPECT_LT(glm::distance(turned.normals[0], glm::vec3(0, -1, 0)), 1e-6f);
  EXPECT_LT(glm::distance(turned.world(2), glm::dvec3(1, 2, 8)), 1e-6);
}

TEST(Align, WhatHasNoExtentIsRefused) {
  TriMesh point;
  point.positions = {{1, 1, 1}, {1, 1, 1}};
  Progress silent;
  EXPECT_THROW(align(point, Truth(shape()), 1, silent), Error);
}

}  // namespace
}  // namespace photohull::eval
