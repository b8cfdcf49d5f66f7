// Sheets and stems of the hull that the volume has torn.
#include "refine/thin_hull.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"
#include "support/cameras.h"
#include "volume/components.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::ivec3;

const ivec3 kBricks(6, 6, 5);
const dvec3 kMiddle(23.5, 23.5, 20);

/// A square sheet through kMiddle, across a unit normal.
Distance sheet(const dvec3& normal, double thickness, double offset = 0) {
  return [=](const dvec3& p) {
    const dvec3 q = p - kMiddle;
    const double across = glm::dot(q, normal);
    return std::max(std::abs(across - offset) - thickness / 2,
                    glm::length(q - across * normal) - 16);
  };
}

/// Without what is nearer than `radius` to the axis through `at`.
Distance pierced(const Distance& body, const dvec3& at, const dvec3& axis, double radius) {
  return [=](const dvec3& p) {
    const dvec3 q = p - at;
    return std::max(body(p), radius - glm::length(q - glm::dot(q, axis) * axis));
  };
}

const dvec3 kNormals[] = {
    {0, 0, 1}, glm::normalize(dvec3(1, 1, 1)), glm::normalize(dvec3(0.3, -0.2, 1))};

TEST(KeepThinHull, ASmallHoleOfASheetIsClosed) {
  for (const dvec3& normal : kNormals) {
    const Distance whole = sheet(normal, 1);
    const SparseVolume hull = sample_volume(kBricks, whole);
    SparseVolume volume = sample_volume(kBricks, pierced(whole, kMiddle, normal, 1));
    const SparseVolume before = volume;
    ASSERT_LT(volume.inside_voxels(), hull.inside_voxels());
    ASSERT_GT(volume.interpolated(kMiddle), 0);
    const std::size_t back = keep_thin_hull(hull, {}, volume);
    EXPECT_EQ(volume.inside_voxels(), before.inside_voxels() + back);
    EXPECT_EQ(volume.inside_voxels(), hull.inside_voxels());
    EXPECT_LT(volume.interpolated(kMiddle), 0);
    for (std::size_t i = 0; i < volume.distance.size(); ++i)
      EXPECT_LE(volume.distance[i], before.distance[i]);
    EXPECT_EQ(volume.table, before.table);
  }
}

TEST(KeepThinHull, AGapOfAStemIsClosed) {
  const Distance stem = [](const dvec3& p) { return std::hypot(p.x - 20.3, p.y - 19.8) - 0.7; };
  const SparseVolume hull = sample_volume(kBricks, stem);
  SparseVolume volume = sample_volume(
      kBricks, [&](const dvec3& p) { return std::max(stem(p), 1 - std::abs(p.z - 17.5)); });
  const auto holds = [&](int z) { return volume.interpolated({20.3, 19.8, double(z)}) < 0; };
  ASSERT_FALSE(holds(17) || holds(18));
  EXPECT_GT(keep_thin_hull(hull, {}, volume), 0u);
  for (int z = 2; z < 38; ++z) EXPECT_TRUE(holds(z)) << z;
}

TEST(KeepThinHull, ASheetThatPhotographsMovedStays) {
  for (const dvec3& normal : kNormals)
    for (const double thickness : {1.0, 1.5})
      for (const double offset : {-1.0, -0.7, 0.7, 1.0}) {
        const SparseVolume hull = sample_volume(kBricks, sheet(normal, thickness));
        SparseVolume volume = sample_volume(kBricks, sheet(normal, thickness, offset));
        const std::vector<float> before = volume.distance;
        keep_thin_hull(hull, {}, volume);
        int changed = 0;
        for (std::size_t i = 0; i < before.size(); ++i) {
          const ivec3 voxel =
              volume.bricks[i / kBrickVoxels] * kBrickEdge + ivec3(i >> 6 & 7, i >> 3 & 7, i & 7);
          // The rim has no thickness to be told by.
          if (glm::distance(dvec3(voxel), kMiddle) < 12) changed += before[i] != volume.distance[i];
        }
        EXPECT_EQ(changed, 0) << "normal z " << normal.z << ", " << thickness << " thick, moved by "
                              << offset;
      }
}

TEST(KeepThinHull, WhatPhotographsFreedStaysFree) {
  // The volume has nothing of the second sheet.
  const Distance first = sheet({0, 0, 1}, 1), both = [&](const dvec3&p) {
    return std::min(first(p), first(p - dvec3(0, 0, 12)));
  };
  const SparseVolume hull = sample_volume(kBricks, both);
  SparseVolume volume = sample_volume(kBricks, first);
  const std::vector<float> before = volume.distance;
  EXPECT_EQ(keep_thin_hull(hull, {}, volume), 0u);
  EXPECT_EQ(volume.distance, before);
  // The middle of a wide hole is as far away.
  volume = sample_volume(kBricks, pierced(first, kMiddle, {0, 0, 1}, 7));
  keep_thin_hull(hull, {}, volume);
  EXPECT_GT(volume.interpolated(kMiddle), 0);
  EXPECT_GT(volume.interpolated(kMiddle + dvec3(4, 0, 0)), 0);
}

/// Views that show the axis x = 20.3, y = 19.8 (voxels) as a line, or nothing.
class Shown {
 public:
  Shown(const GridSpec& grid, bool line)
      : cameras(test::cameras_around(grid.origin + grid.voxel_size * dvec3(20, 20, 18),
                                     120 * grid.voxel_size, 6, 200, 160, 120)) {
    for (const Camera& camera : cameras) {
      SilhouetteDistance& d = distances_.emplace_back();
      d.width = 160, d.height = 120;
      d.pixels.assign(160 * 120, 1.0f);
      std::vector<LinePoint>& points = lines_.emplace_back();
      for (double z = 0; line && z < 40; z += 0.5) {
        const auto at = camera.project(grid.origin + grid.voxel_size * dvec3(20.3, 19.8, z));
        if (at) points.push_back({float(at->x), float(at->y), 1, 0, 1});
      }
    }
    for (std::size_t i = 0; i < cameras.size(); ++i)
      silhouettes.push_back({nullptr, &distances_[i], &lines_[i]});
  }

  std::vector<Camera> cameras;
  std::vector<carving::Silhouette> silhouettes;

 private:
  std::vector<SilhouetteDistance> distances_;
  std::vector<std::vector<LinePoint>> lines_;
};

/// With a gap of five voxels.
SparseVolume torn(const Distance& body) {
  return sample_volume(
      kBricks, [&](const dvec3& p) { return std::max(body(p), 2.6 - std::abs(p.z - 17.5)); });
}

TEST(RejoinStems, WhatTheHullJoinsByAStemIsOnePieceAgain) {
  const Distance stem = [](const dvec3& p) { return std::hypot(p.x - 20.3, p.y - 19.8) - 0.9; };
  const SparseVolume hull = sample_volume(kBricks, stem);
  SparseVolume volume = torn(stem);
  const Shown shown(hull.grid, true), unseen(hull.grid, false);
  ASSERT_EQ(component_sizes(volume).size(), 2u);
  const std::size_t inside = volume.inside_voxels();
  EXPECT_EQ(rejoin_stems(hull, unseen.cameras, unseen.silhouettes, {}, volume), 0u)
      << "no mask shows a line there";
  const std::size_t back = rejoin_stems(hull, shown.cameras, shown.silhouettes, {}, volume);
  EXPECT_EQ(component_sizes(volume).size(), 1u);
  EXPECT_EQ(volume.inside_voxels(), inside + back);
  EXPECT_LE(back, 6u);  // voxels of the gap
}

TEST(RejoinStems, PartsThatPhotographsPutApartStayApart) {
  // The hull joins them by a thick neck, which photographs can judge.
  const Distance body = box({10, 10, 4}, {30, 30, 36});
  const SparseVolume hull = sample_volume(kBricks, body);
  SparseVolume volume = torn(body);
  const Shown shown(hull.grid, true);
  const std::vector<float> before = volume.distance;
  EXPECT_EQ(rejoin_stems(hull, shown.cameras, shown.silhouettes, {}, volume), 0u);
  EXPECT_EQ(volume.distance, before);
}

TEST(KeepThinHull, ThickPartsKeepTheirHollows) {
  const Distance block = box({8, 8, 12}, {40, 40, 24});
  const SparseVolume hull = sample_volume(kBricks, block);
  SparseVolume volume = sample_volume(kBricks, [&](const dvec3& p) {
    // A hollow of the upper side, and a narrow bore through all of it.
    return std::max({block(p), 6 - glm::distance(p, dvec3(20, 20, 25)),
                     1 - std::hypot(p.x - 32.5, p.y - 32.5)});
  });
  const std::vector<float> before = volume.distance;
  EXPECT_EQ(keep_thin_hull(hull, {}, volume), 0u);
  EXPECT_EQ(volume.distance, before);
}

TEST(KeepThinHull, DepthAndReachSayWhatIsThinAndWhatIsBeside) {
  const Distance whole = sheet({0, 0, 1}, 3);  // voxels thick: 1.5 deep
  const SparseVolume hull = sample_volume(kBricks, whole);
  const auto back = [&](double hole, const ThinHullOptions& options) {
    SparseVolume volume = sample_volume(kBricks, pierced(whole, kMiddle, {0, 0, 1}, hole));
    return keep_thin_hull(hull, options, volume);
  };
  EXPECT_EQ(back(1, {}), 0u);
  EXPECT_GT(back(1, {.depth = 2}), 0u);
  EXPECT_EQ(back(1, {.depth = 0}), 0u);
  EXPECT_GT(back(3, {.depth = 2, .reach = 2.9}), back(3, {.depth = 2, .reach = 1}));
}

}  // namespace
}  // namespace photohull::refine
