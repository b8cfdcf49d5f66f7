// A textured wall, and something before it that the photographs do not show.
#include "refine/look_through.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/gl_context.h"
#include "wall_scene.h"

namespace photohull::refine {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::ivec3;
using glm::vec3;

const dvec3 kBall(24, 24, 30);
constexpr double kRadius = 7;

class LookThrough : public WallScene {
 protected:
  LookThrough() { photograph(false); }

  /// The wall alone, or with the ball before it, both textured.
  void photograph(bool ball) {
    const dvec3 middle = test::kGrid.world(kBall);
    const double radius = kRadius * test::kGrid.voxel_size;
    WallScene::photograph(0.15, [&](const dvec3& eye, const dvec3& ray) {
      const double b = glm::dot(ray, eye - middle);
      const double under = b * b - glm::dot(eye - middle, eye - middle) + radius * radius;
      return ball && under > 0 ? -b - std::sqrt(under) : kNever;
    });
  }

  static SparseVolume body(bool ball) {
    return sample_volume(test::kGrid.bricks, [&](const dvec3& p) {
      const double wall = p.z - kWall;
      return ball ? std::min(wall, glm::distance(p, kBall) - kRadius) : wall;
    });
  }

  /// Surfels of the wall that lie behind the ball for some views, which `hidden` names.
  KnownSurface wall(const std::vector<int>& hidden) const {
    KnownSurface known;
    for (int x = 18; x <= 30; ++x)
      for (int y = 18; y <= 30; ++y) {
        known.positions.emplace_back(x, y, kWall);
        known.normals.emplace_back(0, 0, 1);
        known.weights.push_back(1);
        ViewChoice choice = test::choice_of({0, 1, 5, 6});
        for (const int view : hidden) choice.hidden.push_back(view);
        known.choices.push_back(choice);
      }
    return known;
  }

  std::vector<Sightline> look(const KnownSurface& known) {
    gpu::Context& context = test::gl_context();  // before the images need it
    const projtex::ImageSet images(views_);
    const std::vector<Camera> cameras = projtex::cameras_of(views_);
    auto lines = find_sightlines(context, test::kGrid, known, {images, cameras, test::kNoise},
                                 MatchOptions(), options_);
    context.check_errors("look through test");
    return lines;
  }

  std::size_t free(const std::vector<Sightline>& lines, const std::vector<vec3>& known,
                   SparseVolume& volume) const {
    return free_sightlines(lines, known, projtex::cameras_of(views_), options_, volume);
  }

  LookOptions options_;
};

int inside(const SparseVolume& volume, const dvec3& centre, double radius) {
  int count = 0;
  const ivec3 n = volume.grid.voxels();
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x)
        count += glm::distance(dvec3(x, y, z), centre) < radius && volume.at({x, y, z}) < 0;
  return count;
}

SparseVolume on_grid(SparseVolume volume) {
  volume.grid = test::kGrid;
  return volume;
}

TEST_F(LookThrough, WhatPhotographsDoNotShowGoes) {
  const KnownSurface known = wall({2, 3, 4});
  const std::vector<Sightline> lines = look(known);
  EXPECT_GT(lines.size(), known.positions.size() * 2);
  SparseVolume volume = on_grid(body(true));
  const int ball = inside(volume, kBall, kRadius), before = int(volume.inside_voxels());
  const int freed = int(free(lines, known.positions, volume));
  EXPECT_LT(inside(volume, kBall, kRadius), 0.2 * ball);
  EXPECT_EQ(int(volume.inside_voxels()), before - freed);
  EXPECT_EQ(inside(volume, {24, 24, 6}, 5), inside(on_grid(body(false)), {24, 24, 6}, 5))
      << "the wall stays";
}

TEST_F(LookThrough, WhatPhotographsShowStays) {
  photograph(true);
  for (const Sightline& line : look(wall({3})))  // a camera straight above
    EXPECT_GT(glm::length(dvec2(line.from) - dvec2(kBall)), kRadius - 1.5);
}

TEST_F(LookThrough, LinesStartAboveTheSurface) {
  options_.margin = 3;
  const std::vector<Sightline> lines = look(wall({3}));
  ASSERT_FALSE(lines.empty());
  for (const Sightline& line : lines) {
    EXPECT_NEAR(line.from.z, kWall + 3, 1e-3);
    EXPECT_EQ(line.view, 3);
  }
}

TEST_F(LookThrough, TooFewViewsVouchForNothing) {
  KnownSurface known = wall({2, 3, 4});
  for (ViewChoice& choice : known.choices) choice.views = test::choice_of({0, 1}).views;
  EXPECT_TRUE(look(known).empty());
  EXPECT_TRUE(look(wall({})).empty());
  known = wall({2, 3, 4});
  std::fill(known.weights.begin(), known.weights.end(), 0.4f);
  EXPECT_TRUE(look(known).empty()) << "peaks that are not distinct";
  EXPECT_TRUE(look({}).empty());
}

TEST_F(LookThrough, OneLineIsNotEnoughAndKnownSurfaceStays) {
  const Sightline line{{24, 24, 14}, 3};
  SparseVolume volume = on_grid(body(true));
  const std::vector<float> before = volume.distance;
  EXPECT_EQ(free({}, {}, volume), 0u);
  EXPECT_EQ(free({line}, {}, volume), 0u);
  EXPECT_EQ(volume.distance, before);
  options_.least_lines = 1;
  EXPECT_GE(free({line}, {}, volume), std::size_t(2 * kRadius - 2));
  EXPECT_GT(volume.at({24, 24, 30}), 0);
  EXPECT_LT(volume.at({28, 24, 30}), 0);
  SparseVolume kept = on_grid(body(true));
  free({line}, {vec3(24, 24, 30)}, kept);
  EXPECT_LT(kept.at({24, 24, 30}), 0);
  EXPECT_GT(kept.at({24, 24, 34}), 0);
}

TEST_F(LookThrough, BricksDeepInsideAreStoredWhenTheyAreFreed) {
  SparseVolume volume = on_grid(sample_volume(test::kGrid.bricks, [](const dvec3& p) {
    const dvec3 off = glm::abs(p - dvec3(23.5)) - 20.0;
    return std::max({off.x, off.y, off.z});
  }));
  const std::size_t deep = volume.grid.brick_index({2, 2, 2});
  ASSERT_EQ(volume.table[deep], SparseVolume::kInside);
  options_.least_lines = 1;
  free({{{20, 20, 20}, 3}}, {}, volume);
  ASSERT_LT(volume.table[deep], SparseVolume::kInside);
  EXPECT_GT(volume.at({20, 20, 20}), 0);
  EXPECT_EQ(volume.at({17, 17, 20}), -SparseVolume::kBand);
}

TEST_F(LookThrough, KnownSurfaceLiesAtGoodPeaks) {
  const std::vector<vec3> positions(4, vec3(1, 2, 3)), normals(4, vec3(0, 0, 1));
  const std::vector<Peak> peaks{{0.5, 1, 0.95f}, {0, 1, 0.5f}, {0, 0, 0.95f}, {-1, 0.1f, 0.92f}};
  std::vector<ViewChoice> choices;
  for (int i = 0; i < 4; ++i) choices.push_back(test::choice_of({i, 4}));
  const KnownSurface known = known_surface(positions, normals, peaks, choices, options_);
  ASSERT_EQ(known.positions.size(), 2u);
  EXPECT_EQ(known.positions[0], vec3(1, 2, 3.5));
  EXPECT_EQ(known.positions[1], vec3(1, 2, 2));
  EXPECT_EQ(known.choices[1].reference(), 3);
  EXPECT_FLOAT_EQ(known.weights[1], 0.1f);
}

}  // namespace
}  // namespace photohull::refine
