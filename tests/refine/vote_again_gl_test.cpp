// A textured wall with a rod before it, or with nothing before it.
#include <gtest/gtest.h>

#include <cmath>

#include "refine/ray_maps.h"
#include "refine/vote.h"
#include "support/gl_context.h"
#include "wall_scene.h"

namespace photohull::refine {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::ivec3;

const dvec2 kRod(22, 26);  // x and z of its axis, along y
constexpr double kRadius = 1.3;

class VoteAgain : public WallScene {
 protected:
  /// The wall alone, or with the rod before it.
  void photograph(bool rod) {
    const dvec3 axis = test::kGrid.world({kRod.x, 0, kRod.y});
    const double radius = kRadius * test::kGrid.voxel_size;
    WallScene::photograph(0.12, [&](const dvec3& eye, const dvec3& ray) {
      const dvec2 o(eye.x - axis.x, eye.z - axis.z), d(ray.x, ray.z);
      const double a = glm::dot(d, d), b = glm::dot(o, d);
      const double under = b * b - a * (glm::dot(o, o) - radius * radius);
      return rod && under > 0 ? (-b - std::sqrt(under)) / a : kNever;
    });
  }

  static double rod(const dvec3& p) { return std::hypot(p.x - kRod.x, p.z - kRod.y) - kRadius; }

  static SparseVolume block() {
    return sample_volume(test::kGrid.bricks, box(dvec3(6, 6, -10), dvec3(42, 42, 36)));
  }
  /// The wall, and what `before` says stands before it.
  static SparseVolume body(const Distance& before) {
    return sample_volume(test::kGrid.bricks, [&](const dvec3& p) {
      return std::max(box(dvec3(6, 6, -10), dvec3(42, 42, 36))(p),
                      std::min(p.z - kWall, before(p)));
    });
  }

  Revision vote(SparseVolume& volume, const VoteOptions& options = {}) {
    SparseVolume hull = block();
    hull.grid = volume.grid = test::kGrid;
    gpu::Context& context = test::gl_context();
    const projtex::ImageSet images(views_);
    const std::vector<Camera> cameras = projtex::cameras_of(views_);
    return vote_again(context, volume, hull, {images, cameras, 0.01}, options);
  }
};

double nothing(const dvec3&) { return 100; }

TEST_F(VoteAgain, RodBeforeTheWallComesBack) {
  photograph(true);
  SparseVolume volume = body(nothing);
  VoteOptions options;
  options.again_score = 0.5;  // half of a patch as wide as this rod shows the wall
  const Revision revision = vote(volume, options);
  int axis = 0, inside = 0, stray = 0;
  for (int y = 10; y < 38; ++y)
    for (int x = 8; x < 40; ++x)
      for (int z = int(kWall) + 2; z < 35; ++z) {
        const bool in = volume.at({x, y, z}) < 0;
        stray += in && rod(dvec3(x, y, z)) > 2.5;
        if (x == int(kRod.x) && z == int(kRod.y)) ++axis, inside += in;
      }
  EXPECT_GT(inside, 0.6 * axis);
  EXPECT_LT(stray, 10);
  EXPECT_GT(revision.added, 50u);
}

TEST_F(VoteAgain, BodyThatThePhotographsLookPastGoes) {
  photograph(false);
  const dvec3 ball(24, 24, 26);
  SparseVolume volume = body(sphere(ball, 5));
  const Revision revision = vote(volume);
  int left = 0, all = 0, wall = 0;
  for (int x = 10; x < 38; ++x)
    for (int y = 10; y < 38; ++y)
      for (int z = 1; z < 35; ++z) {
        const dvec3 p(x, y, z);
        if (glm::distance(p, ball) < 5) ++all, left += volume.at({x, y, z}) < 0;
        if (z < kWall - 1) wall += volume.at({x, y, z}) >= 0;
      }
  EXPECT_LT(left, 0.1 * all);
  EXPECT_EQ(wall, 0);
  EXPECT_GT(revision.freed, 100u);
  EXPECT_EQ(revision.added, 0u);
}

TEST_F(VoteAgain, FreeingAndAddingTakeVotesOfTheirOwn) {
  photograph(true);
  VoteOptions options;
  options.again_score = 0.5;
  const auto revise = [&](double adding, double freeing) {
    options.again_weight = adding;
    options.freeing_weight = freeing;
    SparseVolume volume = body(sphere({30, 24, 24}, 3));
    return vote(volume, options);
  };
  const double never = 1e6, usual = 1.5;
  EXPECT_EQ(revise(usual, never).freed, 0u);
  EXPECT_GT(revise(usual, never).added, 0u);
  EXPECT_EQ(revise(never, usual).added, 0u);
  EXPECT_GT(revise(never, usual).freed, 0u);
}

TEST_F(VoteAgain, RaysAreNoCloserThanPixelsTellApart) {
  photograph(false);
  SparseVolume hull = block();
  hull.grid = test::kGrid;
  VoteOptions options;
  options.ray_spacing = 0.01;                  // voxels, which are about a pixel wide here
  gpu::Context& context = test::gl_context();  // before the images need it
  const projtex::ImageSet images(views_);
  const std::vector<Camera> cameras = projtex::cameras_of(views_);
  for (const RayMap& map : match_rays(context, hull, {images, cameras, 0.01}, options))
    EXPECT_DOUBLE_EQ(map.stride, 1.5);
}

TEST_F(VoteAgain, WhatThePhotographsShowStays) {
  photograph(true);
  SparseVolume volume = body(rod);
  vote(volume);
  int lost = 0;
  for (int y = 10; y < 38; ++y) lost += volume.at({int(kRod.x), y, int(kRod.y)}) >= 0;
  EXPECT_LE(lost, 2);  // of 28
}

TEST_F(VoteAgain, PlainImagesChangeNothing) {
  for (PreparedView& view : views_)
    view.image = {test::kImageEdge, test::kImageEdge, ColourImage::Encoding::kSrgb8, false,
                  std::vector<std::uint8_t>(4 * 64 * 64, 120)};
  SparseVolume volume = body(sphere({24, 24, 26}, 5));
  const std::vector<float> before = volume.distance;
  const Revision revision = vote(volume);
  EXPECT_EQ(volume.distance, before);
  EXPECT_EQ(revision.added + revision.freed, 0u);
}

}  // namespace
}  // namespace photohull::refine
