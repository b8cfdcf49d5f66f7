// Dust told from pieces that masks ask for.
#include "refine/dust.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"
#include "support/gl_context.h"
#include "support/silhouettes.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::ivec3;

const ivec3 kBricks(6, 6, 6);
const dvec3 kMiddle(23.5, 23.5, 23.5);
constexpr double kRadius = 8;

/// Nine views of a ball, and of a speck above it where `speck_shown` says so.
class Dust : public ::testing::Test {
 protected:
  void look(int views_with_speck, bool likelihood = false) {
    const SparseVolume grid = sample_volume(kBricks, [](const dvec3&) { return 1.0; });
    const auto world = [&](const dvec3& voxel) { return grid.grid.world(voxel); };
    cameras_ = test::cameras_around(world(kMiddle), 200 * grid.grid.voxel_size, 9, 900, 300, 300);
    outlines_.clear(), silhouettes_.clear();
    for (int i = 0; i < int(cameras_.size()); ++i) {
      const auto ball = cameras_[std::size_t(i)].project(world(kMiddle));
      const auto speck = cameras_[std::size_t(i)].project(world(kSpeck));
      const double radius = kRadius * 900.0 / 200;
      outlines_.push_back(test::rasterise(300, 300, [&](const glm::dvec2& p) {
        const double of_ball = glm::distance(p, *ball) - radius;
        const double of_speck = glm::distance(p, *speck) - 6;
        return i < views_with_speck ? std::min(of_ball, of_speck) : of_ball;
      }));
    }
    for (const test::Outline& o : outlines_)
      silhouettes_.push_back({&o.mask, &o.distance, nullptr, likelihood});
  }

  bool is_asked_for() {
    const auto body = [](const dvec3& p) {
      return std::min(glm::distance(p, kMiddle) - kRadius, glm::distance(p, kSpeck) - 1.2);
    };
    const SparseVolume volume = sample_volume(kBricks, body);
    std::vector<std::vector<ivec3>> pieces(1);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (const ivec3 v = ivec3(kSpeck) + ivec3(x, y, z); volume.at(v) < 0)
            pieces[0].push_back(v);
    EXPECT_FALSE(pieces[0].empty());
    return are_asked_for(test::gl_context(), volume, pieces, {cameras_, silhouettes_}, {}).at(0);
  }

  static constexpr dvec3 kSpeck{23, 23, 42};
  std::vector<Camera> cameras_;
  std::vector<test::Outline> outlines_;
  std::vector<carving::Silhouette> silhouettes_;
};

TEST_F(Dust, WhatMasksShowAloneIsAskedFor) {
  look(9);
  EXPECT_TRUE(is_asked_for());
  look(4);
  EXPECT_TRUE(is_asked_for());
}

TEST_F(Dust, WhatNoMaskShowsIsDust) {
  look(0);
  EXPECT_FALSE(is_asked_for());
  look(1);
  EXPECT_FALSE(is_asked_for());
}

TEST_F(Dust, MasksThatWereMadeAskForNothing) {
  look(9, true);
  EXPECT_FALSE(is_asked_for());
}

TEST_F(Dust, NothingAsksWithoutMasks) {
  look(9);
  for (carving::Silhouette& s : silhouettes_) s = {};
  EXPECT_FALSE(is_asked_for());
}

}  // namespace
}  // namespace photohull::refine
