#include "refine/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "core/error.h"
#include "refine/view_choice.h"
#include "refine_surface.h"
#include "support/analytic_volumes.h"
#include "support/gl_context.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

TEST_F(RefineSurface, WhatIsSettledStaysCoarseAndIsNotMatchedAgain) {
  run(8);
  const auto samples = [&] { return report_.levels[1].samples; };
  const std::int64_t all = samples(), surfels = report_.levels[1].surfels;
  options_.settle.least_pixels = 1000;
  const SparseVolume volume = run(8);
  EXPECT_EQ(report_.levels[0].split, 0);
  EXPECT_GT(report_.levels[0].settled_pixels, 30);
  // Only bricks that the first level's surface did not pass are matched.
  EXPECT_LT(samples(), 0.2 * double(all));
  EXPECT_LT(double(report_.levels[1].surfels), 0.6 * double(surfels));
  EXPECT_LT(test::mean_error(volume), 0.4) << "the coarse level's surface";
}

TEST_F(RefineSurface, TheHullIsBelievedByLargerVoxelsWhereTheLastOnesTellNothing) {
  options_.levels = 3;
  options_.settle.least_pixels = 3;  // the last level matches nothing
  run(8);
  ASSERT_EQ(report_.levels[1].split, 0);
  const HullTrust larger = report_.levels[1].hull_trust.value();
  EXPECT_LT(larger[0], 0.9);
  EXPECT_NE(larger[1], larger[0]);
  const HullTrust last = report_.levels[2].hull_trust.value();
  for (std::size_t i = 0; i < last.size(); ++i)
    EXPECT_NEAR(last[i], larger[std::min(i + 1, last.size() - 1)], 1e-9) << i;
  EXPECT_EQ(report_.fits.back().hull_trust.value(), last);
}

TEST_F(RefineSurface, FindsTheBowl) {
  const SparseVolume volume = run(8);
  const SparseVolume hull = scene_.hull(scene_.grid(8));
  EXPECT_LT(test::mean_error(volume), 0.15);
  EXPECT_LT(test::mean_error(volume), 0.15 * test::mean_error(hull));
  EXPECT_EQ(open_edges(extract_mesh(volume)), 0u);
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot) {
    const glm::ivec3 voxel = volume.bricks[slot] * kBrickEdge;
    EXPECT_GE(volume.at(voxel), hull.at(voxel)) << "the hull bounds the result";
  }

  ASSERT_EQ(report_.levels.size(), 2u);
  EXPECT_DOUBLE_EQ(report_.levels[0].voxel_size, 2 * report_.levels[1].voxel_size);
  EXPECT_DOUBLE_EQ(report_.levels[1].voxel_size, volume.grid.voxel_size);
  EXPECT_EQ(report_.levels[1].bricks, std::int64_t(volume.bricks.size()));
  for (const LevelReport& level : report_.levels) {
    EXPECT_GT(level.surfels, 1000);
    EXPECT_GT(level.samples, level.surfels);
    EXPECT_GT(level.mean_move, 0);
    EXPECT_LT(level.mean_move, 1);
    EXPECT_GT(level.split, 30);
    EXPECT_LE(level.split + level.settled_pixels + level.settled_plain + level.settled_flat,
              level.bricks);
  }
}

TEST_F(RefineSurface, SameDistancesInEveryRun) {
  const SparseVolume first = run(4), second = run(4);
  EXPECT_EQ(first.table, second.table);
  EXPECT_EQ(first.distance, second.distance);
}

TEST_F(RefineSurface, HoldingAFewPhotographsAtATimeChangesNothing) {
  constexpr int kEdge = 6;
  const SparseVolume all = run(kEdge);
  FewPhotographs few(scene_, ViewChoice::kMostViews, options_.noise_sigma);
  larger_ = &few;
  const SparseVolume some = run(kEdge);
  EXPECT_GT(few.times(), 3 * int(scene_.views.size()) / ViewChoice::kMostViews);
  EXPECT_EQ(all.table, some.table);
  EXPECT_EQ(all.distance, some.distance);
}

/// The bowl, moved by an offset in voxels, on a lattice of its own.
SparseVolume moved_bowl(const GridSpec& grid, const glm::dvec3& offset) {
  return sample_volume(
      grid.bricks + 1,
      [&](const glm::dvec3& v) {
        return test::bowl(grid.world(v - 3.5 - offset)) / grid.voxel_size;
      },
      grid.world(glm::dvec3(-3.5)), grid.voxel_size);
}

TEST_F(RefineSurface, FollowsTheMomentBefore) {
  options_.levels = 3;
  const double alone = test::mean_error(run(8));
  EXPECT_FALSE(report_.followed);
  const MomentBefore before{moved_bowl(scene_.grid(8), {2, -1.5, 1})};
  before_ = &before;
  const double followed = test::mean_error(run(8));
  EXPECT_TRUE(report_.followed);
  EXPECT_EQ(report_.levels.size(), 2u);
  EXPECT_LT(followed, 1.1 * alone);
}

TEST_F(RefineSurface, AMomentThatFollowedLeavesTheLastLevelAlone) {
  options_.levels = 3;
  const MomentBefore before{moved_bowl(scene_.grid(8), {0.5, -0.4, 0.3}), true};
  const double alone = test::mean_error(run(8));
  before_ = &before;
  const double followed = test::mean_error(run(8));
  EXPECT_TRUE(report_.followed);
  EXPECT_EQ(report_.levels.size(), 1u);
  EXPECT_LT(followed, 1.1 * alone);
}

TEST_F(RefineSurface, AMomentThatIsElsewhereIsNotFollowed) {
  options_.levels = 3;
  const SparseVolume alone = run(6);
  const MomentBefore before{moved_bowl(scene_.grid(6), glm::dvec3(18, 0, 0))};
  before_ = &before;
  const SparseVolume volume = run(6);
  EXPECT_FALSE(report_.followed);
  EXPECT_EQ(volume.table, alone.table);
  EXPECT_EQ(volume.distance, alone.distance);
}

TEST_F(RefineSurface, WithoutMasksNoMomentIsFollowed) {
  const MomentBefore before{moved_bowl(scene_.grid(4), glm::dvec3(0))};
  before_ = &before;
  run(4, false);
  EXPECT_FALSE(report_.followed);
}

TEST_F(RefineSurface, WithoutMasks) {
  const SparseVolume box = scene_.hull(scene_.grid(5), false);
  const SparseVolume volume = run(5, false);
  EXPECT_GT(volume.inside_voxels(), 1000u);
  EXPECT_LT(test::mean_error(volume), 0.5 * test::mean_error(box));
}

TEST_F(RefineSurface, OneLevel) {
  options_.levels = 1;
  const SparseVolume volume = run(4);
  EXPECT_LT(test::mean_error(volume), 0.5 * test::mean_error(scene_.hull(scene_.grid(4))));
  EXPECT_EQ(report_.levels.size(), 1u);
}

TEST_F(RefineSurface, VotingFindsWhatTheSearchAloneCannotReach) {
  options_.voting = false;
  const double searched = test::mean_error(run(5));
  options_.voting = true;
  EXPECT_LT(test::mean_error(run(5)), 0.7 * searched);
}

TEST_F(RefineSurface, FittingThePhotographsBringsItNearer) {
  options_.fit_passes = 0;
  const double matched = test::mean_error(run(8));
  EXPECT_TRUE(report_.fits.empty());
  options_.fit_passes = 2;
  EXPECT_LT(test::mean_error(run(8)), matched);
  ASSERT_FALSE(report_.fits.empty());
  EXPECT_TRUE(report_.fits[0].kept);
  EXPECT_GT(report_.fits[0].held_before, 0.3);
  EXPECT_GT(report_.fits[0].mean_move, 0);
}

TEST_F(RefineSurface, TheLastPassSeatsItOnTheOutlinesWhateverTheOthersGained) {
  options_.seat.passes = 0;
  options_.fit_passes = 1;
  const double fitted = test::mean_error(run(8));
  options_.seat = {};
  for (const int passes : {1, 3}) {
    options_.fit_passes = passes;
    EXPECT_LT(test::mean_error(run(8)), 0.95 * fitted) << passes;
    ASSERT_FALSE(report_.fits.empty());
    EXPECT_TRUE(report_.fits.back().kept);
  }
}

TEST_F(RefineSurface, CanBeCancelled) {
  process_cancellation().cancel();
  EXPECT_THROW(run(4), Cancelled);
  process_cancellation().reset();
}

TEST_F(RefineSurface, BadOptionsAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(RefineOptions&)>> mistakes = {
      [](RefineOptions& o) { o.levels = -1; },
      [](RefineOptions& o) { o.levels = 9; },
      [](RefineOptions& o) { o.coarse_iterations = 0; },
      [](RefineOptions& o) { o.fine_offsets = 2; },
      [](RefineOptions& o) { o.coarse_offsets = 65; },
      [](RefineOptions& o) { o.step = 0; },
      [](RefineOptions& o) { o.follow.levels = 0; },
      [](RefineOptions& o) { o.follow.least_inside = 1.1; },
      [](RefineOptions& o) { o.aggregations = -1; },
      [](RefineOptions& o) { o.noise_sigma = 0; },
      [&](RefineOptions& o) { o.noise_sigma = nan; },
      [&](RefineOptions& o) { o.step = nan; },
      [](RefineOptions& o) { o.vote.band = 0; },
      [](RefineOptions& o) { o.vote.least_weight = 0; },
      [](RefineOptions& o) { o.close.longest = -1; },
      [](RefineOptions& o) { o.restore.least_views = 0; },
      [](RefineOptions& o) { o.match.best_pairs = 0; },
      [](RefineOptions& o) { o.match.nearest_angle = o.match.farthest_angle; },
      [](RefineOptions& o) { o.peak.full_score = o.peak.least_score; },
      [](RefineOptions& o) { o.fit_passes = -1; },
      [](RefineOptions& o) { o.fit.slope = 0; },
      [](RefineOptions& o) { o.fit.largest_offset = 3; },
      [&](RefineOptions& o) { o.fit.unit_deviation = nan; },
      [](RefineOptions& o) { o.regularize.robust = 0; }};
  for (std::size_t i = 0; i < mistakes.size(); ++i) {
    options_ = {};
    mistakes[i](options_);
    EXPECT_THROW(options_.validate(), UsageError) << i;
  }
  EXPECT_THROW(run(4), UsageError);
  EXPECT_NO_THROW(RefineOptions().validate());
}

}  // namespace
}  // namespace photohull::refine
