#include "refine/restore.h"

#include <gtest/gtest.h>

#include "refine/coverage.h"
#include "support/analytic_volumes.h"
#include "support/gl_context.h"
#include "support/silhouettes.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::ivec3;

const dvec3 kCentre(15.5);
constexpr double kBall = 8, kRod = 1.2;

/// A ball and a rod that sticks out of it, on a grid of unit voxels.
class Restore : public testing::Test {
 protected:
  double rod(const dvec3& p) const {
    const double t =
        std::clamp(glm::dot(p - from_, to_ - from_) / glm::dot(to_ - from_, to_ - from_), 0.0, 1.0);
    return glm::distance(p, from_ + t * (to_ - from_)) - kRod;
  }
  SparseVolume ball() const { return sample_volume({4, 4, 4}, sphere(kCentre, kBall)); }
  SparseVolume both() const {
    return sample_volume(
        {4, 4, 4}, [&](const dvec3& p) { return std::min(sphere(kCentre, kBall)(p), rod(p)); });
  }

  /// What the cameras see of ball and rod.
  void photograph(const std::vector<Camera>& cameras) {
    cameras_ = cameras;
    for (const Camera& camera : cameras) {
      test::Outline outline = test::sphere_outline(camera, kCentre, kBall);
      const test::Outline wire = test::wire_outline(camera, from_, to_, kRod);
      for (std::size_t i = 0; i < wire.distance.pixels.size(); ++i) {
        outline.distance.pixels[i] = std::min(outline.distance.pixels[i], wire.distance.pixels[i]);
        outline.mask.coverage[i] = std::max(outline.mask.coverage[i], wire.mask.coverage[i]);
      }
      outlines_.push_back(std::move(outline));
    }
  }

  std::size_t restore(SparseVolume& volume, const SparseVolume& hull) {
    std::vector<carving::Silhouette> silhouettes;
    for (const test::Outline& outline : outlines_)
      silhouettes.push_back({&outline.mask, &outline.distance});
    return restore_silhouettes(test::gl_context(), volume, hull, {cameras_, silhouettes}, options_);
  }

  dvec3 from_ = kCentre, to_ = kCentre + dvec3(14, 0, 0);
  std::vector<Camera> cameras_;
  std::vector<test::Outline> outlines_;
  RestoreOptions options_;
};

std::vector<Camera> around() { return test::cameras_around(kCentre, 100, 12, 250, 96, 96); }

TEST_F(Restore, ARodComesBackAndNothingElse) {
  photograph(around());
  const SparseVolume before = ball(), hull = both();
  SparseVolume volume = before;
  EXPECT_GT(restore(volume, hull), 10u);
  const ivec3 n = volume.grid.voxels();
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) {
        const ivec3 voxel(x, y, z);
        EXPECT_GE(volume.at(voxel), std::min(hull.at(voxel), before.at(voxel)));
        EXPECT_LE(volume.at(voxel), before.at(voxel));
        // The rod's axis, from where it leaves the ball to its end.
        if (hull.at(voxel) < -0.5 && x > 15.5 + kBall + 1) {
          EXPECT_LT(volume.at(voxel), 0) << x << ' ' << y << ' ' << z;
        }
        if (rod(voxel) > 2) {
          EXPECT_EQ(volume.at(voxel), before.at(voxel));
        }
      }
}

TEST_F(Restore, NothingComesBackWhereTheVolumeCoversTheSilhouettes) {
  photograph(around());
  SparseVolume volume = both();
  const SparseVolume before = volume;
  EXPECT_EQ(restore(volume, before), 0u);
  EXPECT_EQ(volume.distance, before.distance);
}

TEST_F(Restore, ARodHiddenBehindTheBallStaysAway) {
  std::vector<Camera> cameras;
  for (const double y : {-6.0, -3.0, 0.0, 3.0, 6.0})
    cameras.push_back(test::look_at(kCentre + dvec3(-100, y, 0), kCentre, 250, 96, 96));
  photograph(cameras);
  SparseVolume volume = ball();
  EXPECT_EQ(restore(volume, both()), 0u);
  EXPECT_EQ(volume.inside_voxels(), ball().inside_voxels());
}

TEST_F(Restore, WhatWouldHideMoreThanItExplainsStaysAway) {
  // Two cameras see the rod beside the ball, nine see its end before the ball.
  std::vector<Camera> cameras;
  for (const double z : {-100.0, 100.0})
    cameras.push_back(test::look_at(kCentre + dvec3(0, 0, z), kCentre, 250, 96, 96, {0, 1, 0}));
  for (int i = 0; i < 9; ++i)
    cameras.push_back(
        test::look_at(kCentre + dvec3(100, i % 3 - 1, i / 3 - 1), kCentre, 250, 96, 96));
  photograph(cameras);
  options_.most_before = 4;
  SparseVolume volume = ball();
  restore(volume, both());
  EXPECT_GT(volume.at({28, 15, 15}), 0) << "9 to 2";
  options_.most_before = 5;
  EXPECT_GT(restore(volume, both()), 0u);
  EXPECT_LT(volume.at({28, 15, 15}), 0);
}

TEST_F(Restore, LackingPixelsLeaveNothingOut) {
  photograph(test::cameras_around(kCentre, 60, 12, 250, 96, 96));  // voxels of several pixels
  std::vector<carving::Silhouette> silhouettes;
  for (const test::Outline& outline : outlines_)
    silhouettes.push_back({&outline.mask, &outline.distance});
  std::vector<ivec3> voxels;
  for (int i = 0; i < 32 * 32 * 32; ++i) {
    const ivec3 voxel(i % 32, i / 32 % 32, i / 1024);
    if (std::abs(sphere(kCentre, kBall)(dvec3(voxel))) < 1) voxels.push_back(voxel);
  }
  const SparseVolume hull = both();
  const Coverage coverage(test::gl_context(), hull.grid, voxels, {cameras_, silhouettes});
  for (const double inside : {0.0, 1.5}) {
    const Coverage::LackingPixels lacking = coverage.lacking_pixels(inside);
    int lack = 0, most = 0;
    for (int i = 0; i < 32 * 32 * 32; ++i) {
      const dvec3 point = dvec3(i % 32, i / 32 % 32, i / 1024) + 0.3;
      const int exact = coverage.votes(point, inside).lack;
      EXPECT_GE(coverage.most_lack(point, lacking), exact);
      lack += exact, most += coverage.most_lack(point, lacking);
    }
    EXPECT_GT(lack, 0);
    EXPECT_LT(most, 2 * lack);
  }
}

TEST_F(Restore, TooFewViewsProveNothing) {
  std::vector<Camera> cameras = around();
  cameras.resize(std::size_t(options_.least_views) - 1);
  photograph(cameras);
  SparseVolume volume = ball();
  EXPECT_EQ(restore(volume, both()), 0u);
}

TEST_F(Restore, WithoutSilhouettesThereIsNothingToProve) {
  cameras_ = around();
  outlines_.clear();
  const std::vector<carving::Silhouette> none(cameras_.size());
  SparseVolume volume = ball();
  EXPECT_EQ(restore_silhouettes(test::gl_context(), volume, both(), {cameras_, none}, options_),
            0u);
}

TEST_F(Restore, ToTheGridsBorderAndFromNothing) {
  to_ = kCentre + dvec3(30, 0, 0);  // beyond the grid
  photograph(test::cameras_around(kCentre, 100, 12, 120, 96, 96));
  SparseVolume volume = ball();
  const SparseVolume hull = both();
  EXPECT_GT(restore(volume, hull), 10u);
  EXPECT_LT(volume.at({31, 15, 15}), 0);
  SparseVolume nothing;
  nothing.grid = hull.grid;
  nothing.table.assign(hull.table.size(), SparseVolume::kOutside);
  EXPECT_GT(restore(nothing, hull), 1000u);
  EXPECT_LE(nothing.inside_voxels(), hull.inside_voxels());
}

}  // namespace
}  // namespace photohull::refine
