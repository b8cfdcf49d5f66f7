#include "refine/settle.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/analytic_volumes.h"
#include "support/cameras.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::vec3;

/// One surfel in a grid of 4 x 4 x 4 unit bricks, 100 voxels before a camera whose
/// pixels are voxels there.
class Settle : public testing::Test {
 protected:
  Settle() {
    cameras_.push_back(test::look_at(dvec3(12, 12, 112), dvec3(12), 100, 64, 64, {0, 1, 0}));
    add(vec3(12), {});
  }

  void add(const vec3& position, const vec3& bend, float texture = 0.9f, float weight = 0.9f,
           int views = 3) {
    positions_.push_back(position);
    bends_.push_back(bend);
    matches_.texture.push_back(texture);
    peaks_.push_back({0, weight, 0.9f});
    before_.push_back(Settled::kSplit);
    choices_.push_back(seen_by(views));
  }

  /// Matched in so many views of the first camera.
  static ViewChoice seen_by(int views) {
    ViewChoice out;
    out.seen = 3;
    for (int k = 0; k < views; ++k) out.views.push_back(0);
    return out;
  }

  SettledBricks settle() const {
    return {grid_,
            {positions_, bends_, matches_.texture, peaks_, choices_, before_},
            cameras_,
            options_};
  }

  /// Of a brick with the first surfel as it is now.
  Settled kind() const { return settle().at(grid_, positions_)[0]; }

  GridSpec grid_{dvec3(0), 1, {4, 4, 4}};
  std::vector<Camera> cameras_;
  std::vector<vec3> positions_, bends_;
  Matches matches_;
  std::vector<Peak> peaks_;
  std::vector<ViewChoice> choices_;
  std::vector<Settled> before_;
  SettleOptions options_;
};

TEST_F(Settle, SaysWhy) {
  EXPECT_EQ(kind(), Settled::kFlat);
  bends_[0] = {0.2f, 0, 0};
  EXPECT_EQ(kind(), Settled::kSplit) << "curved";
  bends_[0] = {0, 0.09f, 0};
  EXPECT_EQ(kind(), Settled::kSplit) << "a saddle: its size counts the mixed derivative twice";
  bends_[0] = {};
  peaks_[0].weight = 0.2f;
  EXPECT_EQ(kind(), Settled::kSplit) << "not certain";
  matches_.texture[0] = 0.1f;
  EXPECT_EQ(kind(), Settled::kPlain);
  options_.least_pixels = 0.6;
  EXPECT_EQ(kind(), Settled::kPixels) << "half a pixel";
  choices_[0] = seen_by(1);
  EXPECT_EQ(kind(), Settled::kUnseen);
}

TEST_F(Settle, WhatWasSettledStaysSoAndWhatWasUnseenIsAskedAgain) {
  choices_[0] = seen_by(0);  // settled surfels are not matched
  before_[0] = Settled::kFlat;
  EXPECT_EQ(kind(), Settled::kFlat);
  before_[0] = Settled::kUnseen;
  EXPECT_EQ(kind(), Settled::kUnseen);
  choices_[0] = seen_by(3);
  bends_[0] = {1, 0, 0};
  EXPECT_EQ(kind(), Settled::kSplit) << "somebody sees it now";
  EXPECT_FALSE(is_settled(Settled::kUnseen));
}

TEST_F(Settle, FinerGridsAreCoarseWhereABrickIsSettled) {
  EXPECT_TRUE(SettledBricks().coarse(grid_).empty());
  const GridSpec finer{dvec3(-0.25), 0.5, {8, 8, 8}};
  const std::vector<std::uint8_t> flags = settle().coarse(finer);
  ASSERT_EQ(flags.size(), 512u);
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x)  // the surfel's brick is (1, 1, 1)
        EXPECT_EQ(flags[finer.brick_index({x, y, z})], x / 2 == 1 && y / 2 == 1 && z / 2 == 1);
  bends_[0] = {0.2f, 0, 0};
  const std::vector<std::uint8_t> split = settle().coarse(finer);
  EXPECT_EQ(std::count(split.begin(), split.end(), 1), 0);
}

TEST_F(Settle, WithoutCurvatureNothingIsFlat) {
  bends_.clear();
  EXPECT_EQ(kind(), Settled::kSplit);
}

TEST_F(Settle, OneSurfelSplitsABrick) {
  add({14, 14, 14}, {1, 0, 0});
  add({20, 14, 14}, {});
  const SettledBricks bricks = settle();
  EXPECT_EQ(bricks.at(grid_, positions_),
            (std::vector{Settled::kSplit, Settled::kSplit, Settled::kFlat}));
  EXPECT_EQ(bricks.count(Settled::kSplit), 1);
  EXPECT_EQ(bricks.count(Settled::kFlat), 1);
  EXPECT_EQ(bricks.count(Settled::kPlain), 0);
}

TEST_F(Settle, AnswersOnTheFinerGrid) {
  // Voxel v of the coarse grid holds voxels 2 v and 2 v + 1 of the fine one.
  const GridSpec fine{dvec3(-0.25), 0.5, {8, 8, 8}};
  const SettledBricks bricks = settle();
  const std::vector<vec3> positions{{31.4f, 31.4f, 31.4f}, {31.4f, 31.4f, 33}, {1000, 0, 0}};
  EXPECT_EQ(bricks.at(fine, positions),
            (std::vector{Settled::kFlat, Settled::kSplit, Settled::kSplit}));
  EXPECT_EQ(SettledBricks().at(fine, positions),
            (std::vector{Settled::kSplit, Settled::kSplit, Settled::kSplit}));
}

TEST_F(Settle, OfAWholeDistancesTellWhatIsBelowPixels) {
  // Pixels are voxels where the camera stands 100 away, and half of one is 0.5 there.
  const SparseVolume ball = sample_volume({6, 6, 6}, sphere(dvec3(24), 16), dvec3(0), 1);
  const auto kinds = [&](double near, double far) {
    const std::vector<Camera> cameras = {
        test::look_at(dvec3(24, 24, 40 + near), dvec3(24), 100, 400, 400, {0, 1, 0}),
        test::look_at(dvec3(24, 24, 8 - far), dvec3(24), 100, 400, 400, {0, 1, 0})};
    const SettledBricks settled = settled_below_pixels(ball, cameras, options_);
    const std::vector<vec3> poles = {vec3(24, 24, 40), vec3(24, 24, 8)};
    return settled.at(ball.grid, poles);
  };
  // Each pole looks at its own camera, however near the other one is.
  EXPECT_EQ(kinds(80, 140)[0], Settled::kSplit);
  EXPECT_EQ(kinds(80, 140)[1], Settled::kPixels);
  EXPECT_EQ(kinds(140, 80)[0], Settled::kPixels);
  EXPECT_EQ(kinds(140, 80)[1], Settled::kSplit);
  EXPECT_EQ(settled_below_pixels(ball, {}, options_).count(Settled::kPixels), 0);
  EXPECT_EQ(settled_below_pixels(ball, {}, options_).count(Settled::kSplit),
            std::int64_t(ball.bricks.size()))
      << "what no camera shows is not settled";
}

}  // namespace
}  // namespace photohull::refine
