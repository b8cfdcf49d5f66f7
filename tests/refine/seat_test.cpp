#include "refine/seat.h"

#include <gtest/gtest.h>

#include "refine/outlines.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr float kNothing = 0, kSurely = 100;

/// A ball with a dent, about the x axis, that is so deep in the middle.
Distance dented(double depth) {
  return [depth](const dvec3& p) {
    const dvec3 at = p - kCentre;
    const double turn = at.x / std::max(glm::length(at), 1e-9);  // cosine
    return glm::length(at) - kRadius + depth * std::exp((turn - 1) / 0.1);
  };
}

struct Seated {
  double worst = -10;       ///< voxels from the ball, where the dent is
  double mean_move = 0;     ///< there
  double largest_move = 0;  ///< anywhere
};

Seated seated(const Surface& surface, const Distance& hull, float told, double tight,
              const SeatOptions& options = {}) {
  static const BallViews views(60);
  std::vector<float> moves(surface.positions.size(), 0);
  const SparseVolume volume = sample_volume({4, 4, 4}, hull);
  const VertexGraph graph = make_graph(surface.mesh);
  const std::vector<float> told_at(moves.size(), told), tight_at(moves.size(), float(tight));
  seat_outlines(volume, {views.cameras(), views.silhouettes()},
                {volume.grid, surface.mesh, graph, surface.positions}, {told_at, tight_at}, options,
                moves);
  Seated out;
  int count = 0;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    out.largest_move = std::max(out.largest_move, double(std::abs(moves[i])));
    if (surface.positions[i].x < kCentre.x + 0.9 * kRadius) continue;
    const vec3 moved = surface.positions[i] + moves[i] * surface.mesh.normals[i];
    const double short_by = kRadius - glm::distance(dvec3(moved), kCentre);
    out.worst = std::max(out.worst, short_by);  // the hull cuts off what is beyond
    out.mean_move += moves[i];
    ++count;
  }
  out.mean_move /= std::max(count, 1);
  return out;
}

TEST(SeatOutlines, FillsADentThatOutlinesContradict) {
  const Surface surface(dented(0.8));
  EXPECT_GT(seated(surface, sphere(kCentre, kRadius), kNothing, 1, {.passes = 0}).worst, 0.75);
  EXPECT_LT(seated(surface, sphere(kCentre, kRadius), kNothing, 1).worst, 0.1);
}

TEST(SeatOutlines, WhatPhotographsTellSurelyStays) {
  const Surface surface(dented(0.8));
  EXPECT_LT(seated(surface, sphere(kCentre, kRadius), kSurely, 1).mean_move, 0.05);
}

TEST(SeatOutlines, AHullThatIsLooseIsNotBelieved) {
  // The dent's sides come nearer to the rays than its middle.
  const Surface surface(dented(0.8));
  const double tight = seated(surface, sphere(kCentre, kRadius), 0.01f, 1, {.passes = 1}).mean_move;
  const double loose = seated(surface, sphere(kCentre, kRadius), 0.01f, 0, {.passes = 1}).mean_move;
  EXPECT_GT(tight, loose + 0.03);
  EXPECT_GT(loose, 0.05);  // rays that nothing touches are met all the same
}

TEST(SeatOutlines, NothingGoesWhereOtherSilhouettesLeaveNoRoom) {
  const Surface surface(dented(0.8));
  const SeatOptions options;
  EXPECT_LE(seated(surface, dented(0.8), kNothing, 1).largest_move, 2.1 * options.margin);
}

TEST(SeatOutlines, WhatLiesOnTheHullIsLeftToTheHull) {
  const Surface surface(sphere(kCentre, kRadius - 0.05));
  const Seated result = seated(surface, sphere(kCentre, kRadius), kNothing, 1);
  EXPECT_LT(result.worst, 0);  // all of it beyond, for the caller to intersect
  EXPECT_LT(result.largest_move, 0.5);
  // Photographs that know better are not overruled: a tenth of a voxel is ten of their deviations.
  const Surface under(sphere(kCentre, kRadius - 0.1));
  EXPECT_LT(seated(under, sphere(kCentre, kRadius), 10 * kSurely, 1).largest_move, 0.02);
}

TEST(SeatOutlines, NoPassesMoveNothing) {
  const Surface surface(dented(0.8));
  EXPECT_EQ(seated(surface, sphere(kCentre, kRadius), kNothing, 1, {.passes = 0}).largest_move, 0);
}

// Fields of surfels in a ring: single strong claims count less than many weak ones.
TEST(ToldAround, SingleClaimsCountLittle) {
  constexpr std::uint32_t kCount = 40;
  VertexGraph ring{{0}, {}};
  for (std::uint32_t i = 0; i < kCount; ++i) {
    ring.neighbours.insert(ring.neighbours.end(), {(i + kCount - 1) % kCount, (i + 1) % kCount});
    ring.first.push_back(2 * (i + 1));
  }
  std::vector<float> single(kCount, 0), all(kCount, 0.4f);
  for (std::size_t i = 0; i < kCount; i += 10) single[i] = 4;
  const auto of_single = information_around(ring, single), of_all = information_around(ring, all);
  for (std::size_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(of_all[i], 0.4, 1e-5);
    EXPECT_LT(of_single[i], 0.2);  // their mean is 0.4 as well
    EXPECT_GT(of_single[i], 0);
  }
}

}  // namespace
}  // namespace photohull::refine
