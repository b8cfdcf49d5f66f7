#include "pipeline/part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "projtex/gpu_views.h"
#include "support/analytic_volumes.h"
#include "support/cameras.h"
#include "volume/extract_mesh.h"

namespace photohull::pipeline {
namespace {

using glm::ivec3;

const ivec3 kBricks(9, 7, 12);
const glm::dvec3 kOrigin(4, -7, 2);
constexpr double kVoxel = 0.25;

/// A body on a part of its grid, of two balls.
SparseVolume two_balls() {
  const Distance one = sphere({25, 27, 24}, 17), other = sphere({44, 30, 66}, 14);
  return sample_volume(
      kBricks, [=](const glm::dvec3& p) { return std::min(one(p), other(p)); }, kOrigin, kVoxel);
}

Box box_of(const SparseVolume& whole) { return whole.grid.bounds(); }

TEST(Part, NumbersAreReadAndOthersRefused) {
  const auto part = parse_part("3/8");
  ASSERT_TRUE(part);
  EXPECT_EQ(part->number, 3);
  EXPECT_EQ(part->count, 8);
  EXPECT_EQ(to_string(*part), "3/8");
  for (const char* text : {"", "3", "/", "3/", "/8", "0/8", "9/8", "3/8/2", "3/8 ", " 3/8", "-1/2",
                           "3.0/8", "1/100001", "99999999999/99999999999"})
    EXPECT_FALSE(parse_part(text)) << text;
}

TEST(Part, RangesLeaveNothingOutAndShareTheSurface) {
  const SparseVolume whole = two_balls();
  for (const int count : {1, 2, 3, 5, 8, 13}) {
    std::vector<int> owners(whole.grid.brick_count(), 0);
    std::size_t least = whole.bricks.size(), most = 0;
    for (int number = 1; number <= count; ++number) {
      const BrickRange range = range_of_part(whole, {number, count});
      for (int z = range.first.z; z < range.end.z; ++z)
        for (int y = range.first.y; y < range.end.y; ++y)
          for (int x = range.first.x; x < range.end.x; ++x)
            ++owners[whole.grid.brick_index({x, y, z})];
      const auto own =
          std::size_t(std::count_if(whole.bricks.begin(), whole.bricks.end(),
                                    [&](const ivec3& b) { return range.contains(b); }));
      least = std::min(least, own), most = std::max(most, own);
    }
    for (const int owner : owners) ASSERT_EQ(owner, 1) << count;
    EXPECT_GT(least, 0u);
    EXPECT_LE(most, 3 * whole.bricks.size() / std::size_t(count)) << count;
  }
}

TEST(Part, MorePartsThanLayersAreRefused) {
  const SparseVolume whole = sample_volume({3, 3, 3}, sphere({12, 12, 12}, 2), kOrigin, kVoxel);
  EXPECT_NO_THROW(range_of_part(whole, {1, 1}));
  try {
    for (int number = 1; number <= 40; ++number) range_of_part(whole, {number, 40});
    FAIL() << "a surface of " << whole.bricks.size() << " bricks is no 40 parts";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("make fewer"), std::string::npos);
  }
  SparseVolume nothing = whole;
  nothing.bricks.clear();
  EXPECT_THROW(range_of_part(nothing, {1, 2}), Error);
}

TEST(Part, AllHaveTheFrameOfTheWhole) {
  const SparseVolume whole = two_balls();
  const auto world = [](const GridSpec& grid) {
    const Box frame = grid.frame();
    return Box{grid.world(frame.min), grid.world(frame.max)};
  };
  const Camera camera = test::look_at({40, 20, 25}, {10, 0, 10}, 300, 400, 300);
  // World units: rays and texels are spaced by it.
  const auto depth = [&](const GridSpec& grid) {
    return projtex::viewing_depth(projtex::to_grid(camera, grid), grid) * grid.voxel_size;
  };
  for (const int levels : {1, 2}) {
    const GridSpec one = cut_part(whole, box_of(whole), {1, 1}, levels).grid;
    const Box all = world(one);
    for (int number = 1; number <= 4; ++number) {
      const GridSpec grid = cut_part(whole, box_of(whole), {number, 4}, levels).grid;
      EXPECT_LT(glm::distance(world(grid).min, all.min), 1e-9) << number;
      EXPECT_LT(glm::distance(world(grid).max, all.max), 1e-9) << number;
      EXPECT_NEAR(depth(grid), depth(one), 1e-9) << number;
      const GridSpec coarse = carving::coarser(grid);
      EXPECT_LT(glm::distance(world(coarse).min, world(grid).min), 2 * coarse.voxel_size);
    }
    EXPECT_NE(cut_part(whole, box_of(whole), {1, 4}, levels).grid.after, glm::dvec3(0));
  }
}

TEST(Part, AsFewPartsAreMadeAsHaveRoom) {
  const SparseVolume whole = two_balls();
  const auto largest = [&](int count) {
    double most = 0;
    for (int number = 1; number <= count; ++number)
      most = std::max(most, share_of_part(whole, {number, count}, 2));
    return most;
  };
  EXPECT_EQ(fewest_parts(whole, 2, 1), 2) << "one did not fit";
  for (const double room : {0.9, 0.6, 0.4, 0.3}) {
    const auto count = fewest_parts(whole, 2, room);
    ASSERT_TRUE(count) << room;
    EXPECT_LE(largest(*count), room);
    if (*count > 2) EXPECT_GT(largest(*count - 1), room);
  }
  // What is around a part's own is larger than this.
  EXPECT_EQ(fewest_parts(whole, 2, 0.01), std::nullopt);
  // A halo is two of the whole's bricks at voxels that are as large, and one where they are halved.
  EXPECT_GT(share_of_part(whole, {1, 2}, 0), share_of_part(whole, {1, 2}, 1));
  EXPECT_DOUBLE_EQ(share_of_part(whole, {1, 1}, 1), 1);
}

TEST(Part, VoxelsAreHalvedAndTheHaloIsWideEnough) {
  const SparseVolume whole = two_balls();
  for (const int levels : {1, 2, 3})
    for (int number = 1; number <= 5; ++number) {
      const Part part = cut_part(whole, box_of(whole), {number, 5}, levels);
      EXPECT_EQ(part.grid.voxel_size, std::ldexp(kVoxel, -levels));
      GridSpec coarse = part.grid;
      for (int level = 0; level < levels; ++level) coarse = carving::coarser(coarse);
      EXPECT_EQ(coarse.bricks << levels, part.grid.bricks);
      const glm::dvec3 bricks = (coarse.origin - kOrigin) / (kVoxel * kBrickEdge);
      EXPECT_LT(glm::distance(bricks, glm::round(bricks)), 1e-9) << "the whole's bricks halved";
      EXPECT_EQ(part.first_voxel, ivec3(glm::round(bricks)) * kBrickEdge << levels);
      const ivec3 whole_end = ivec3(glm::round(bricks)) + coarse.bricks;
      for (int a = 0; a < 3; ++a) {
        if (bricks[a] > 0.5) EXPECT_GE(part.own.first[a] * kBrickEdge, kHaloVoxels);
        if (whole_end[a] < kBricks[a])
          EXPECT_GE((part.grid.bricks[a] - part.own.end[a]) * kBrickEdge, kHaloVoxels);
      }
      // What is near has all of the surface in the part's grid; what is beside has none of it.
      const TriMesh mesh = extract_mesh(whole);
      const Box filled = part.grid.bounds();
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (!filled.contains(mesh.world(v))) continue;
        const glm::dvec3 voxel = glm::round((mesh.world(v) - kOrigin) / kVoxel);
        ASSERT_EQ(part.near.at(ivec3(voxel)), whole.at(ivec3(voxel)));
      }
      for (const ivec3& voxel : part.beside)
        ASSERT_FALSE(filled.contains(whole.grid.world(glm::dvec3(voxel))));
    }
}

TEST(Part, TheBoxIsThatOfTheWholeWhereThisEndsFirst) {
  const SparseVolume whole = two_balls();
  Box box = box_of(whole);
  box.min += 3.0, box.max -= 2.0;
  Box all{glm::dvec3(1e9), glm::dvec3(-1e9)};
  for (int number = 1; number <= 4; ++number) {
    const Part part = cut_part(whole, box, {number, 4}, 1);
    all.min = glm::min(all.min, part.box.min), all.max = glm::max(all.max, part.box.max);
    EXPECT_TRUE(glm::all(glm::lessThan(part.box.min, part.box.max)));
  }
  EXPECT_LT(glm::distance(all.min, box.min - 0.25 * kVoxel), 1e-9);
  EXPECT_LT(glm::distance(all.max, box.max + 0.25 * kVoxel), 1e-9);
}

TEST(Part, OwnPartsOfVolumeAndMeshAreTheWholeTogether) {
  const SparseVolume whole = two_balls();
  const TriMesh mesh = extract_mesh(whole);
  std::size_t bricks = 0, triangles = 0;
  constexpr int kCount = 4;
  for (int number = 1; number <= kCount; ++number) {
    Part part = cut_part(whole, box_of(whole), {number, kCount}, 1);
    // As if the whole's voxels were the part's: its own, without a halo.
    part.grid = whole.grid;
    part.own = range_of_part(whole, {number, kCount});
    const SparseVolume own = own_of(part, whole);
    bricks += own.bricks.size();
    for (const ivec3& brick : own.bricks) EXPECT_TRUE(part.own.contains(brick));
    triangles += own_of(part, mesh).triangles.size();
  }
  EXPECT_EQ(bricks, whole.bricks.size());
  EXPECT_EQ(triangles, mesh.triangles.size());
}

TEST(Part, PhotographsThatShowNothingOfItAreLeftOut) {
  const SparseVolume whole = two_balls();
  const Part part = cut_part(whole, box_of(whole), {1, 4}, 1);
  const glm::dvec3 middle = part.box.center();
  std::vector<PreparedView> views;
  const auto add = [&](const char* name, const glm::dvec3& eye, const glm::dvec3& target) {
    PreparedView view{name, test::look_at(eye, target, 200, 160, 120), {}, {}};
    view.image.width = 160, view.image.height = 120;
    view.image.bytes.resize(std::size_t(160) * 120 * 4);
    views.push_back(std::move(view));
  };
  add("shows", middle + glm::dvec3(40, 0, 5), middle);
  add("away", middle + glm::dvec3(40, 0, 5), middle + glm::dvec3(80, 0, 5));
  add("past", middle + glm::dvec3(40, 0, 0), middle + glm::dvec3(0, 70, 0));
  add("behind", middle - glm::dvec3(40, 5, 0), middle);
  std::vector<std::string> left;
  for (const PreparedView& view : views_of(part, views)) {
    left.push_back(view.name);
    EXPECT_LT(view.camera.intrinsics.width, 160) << "what does not show it is gone";
    EXPECT_EQ(view.image.width, view.camera.intrinsics.width);
  }
  EXPECT_EQ(left, (std::vector<std::string>{"shows", "behind"}));
  views.resize(1);
  EXPECT_THROW(views_of(part, views), Error);
}

}  // namespace
}  // namespace photohull::pipeline
