// A part of the bowl from a whole on coarser voxels.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "projtex/photographs.h"
#include "refine_surface.h"
#include "visibility/kernels/depth_maps.h"
#include "volume/skin.h"

namespace photohull::refine {
namespace {

using glm::ivec3;

constexpr int kEdge = 6;  // bricks of the whole

class PartOfBowl : public RefineSurface {
 protected:
  /// The grid of the whole's bricks from `first` up to `end` along x, its voxels halved.
  GridSpec halved(int first, int end) const {
    GridSpec grid = whole_.grid;
    grid.origin.x += grid.voxel_size * kBrickEdge * first;
    grid.voxel_size /= 2;
    grid.origin -= 0.5 * grid.voxel_size;
    grid.bricks = 2 * ivec3(end - first, kEdge, kEdge);
    return grid;
  }

  /// What cameras see of the whole's bricks elsewhere, world units.
  std::vector<DepthMap> depths_beside(int first, int end) const {
    const std::vector<projtex::GridCamera> cameras = projtex::to_grid(scene_.cameras, whole_.grid);
    std::vector<ivec3> voxels = skin(whole_);
    std::erase_if(voxels, [&](const ivec3& voxel) {
      return voxel.x / kBrickEdge >= first && voxel.x / kBrickEdge < end;
    });
    visibility::DepthMaps maps(cameras, whole_.grid);
    maps.draw(test::gl_context(), cameras, voxels);
    std::vector<DepthMap> out;
    for (std::size_t v = 0; v < cameras.size(); ++v) {
      out.push_back(maps.map(v));
      for (float& depth : out.back().depths) depth = float(depth * whole_.grid.voxel_size);
    }
    return out;
  }

  /// The part of the whole's bricks from `first` up to `end`.
  SparseVolume part(int first, int end, std::span<const DepthMap> beside) {
    const auto hull_at = [&](const GridSpec& grid) { return scene_.hull(grid, true); };
    const WholeSurface whole{whole_, ivec3(2 * kBrickEdge * first, 0, 0), 1, beside};
    return refine_surface(
        test::gl_context(),
        {halved(first, end), hull_at, scene_.silhouettes(), projtex::ImageSet(scene_.views),
         scene_.cameras, nullptr, nullptr, nullptr, &whole},
        options_, progress_, &report_);
  }

  /// How voxels of a part, away from where it is cut off, differ from those of `all`: the mean in
  /// voxels near the surface, and how many are inside in one alone.
  struct Difference {
    double mean = 0;
    int sides = 0, inside = 0;
  };
  Difference difference(const SparseVolume& part, int first, int from, int to,
                        const SparseVolume& all) const {
    Difference out;
    int near = 0;
    const ivec3 n = all.grid.voxels();
    for (int x = 2 * kBrickEdge * from; x < 2 * kBrickEdge * to; ++x)
      for (int y = 0; y < n.y; ++y)
        for (int z = 0; z < n.z; ++z) {
          const float a = all.at({x, y, z}), b = part.at({x - 2 * kBrickEdge * first, y, z});
          out.inside += a < 0;
          out.sides += (a < 0) != (b < 0);
          if (std::min(std::abs(a), std::abs(b)) > 1) continue;
          out.mean += std::abs(double(a) - double(b));
          ++near;
        }
    out.mean /= near;
    return out;
  }

  SparseVolume whole_ = run(kEdge);
};

TEST_F(PartOfBowl, IsWhatTheWholeWouldBeThere) {
  const SparseVolume all = part(0, kEdge, {});
  EXPECT_TRUE(report_.followed);
  EXPECT_EQ(report_.levels.size(), 1u);
  EXPECT_LT(test::mean_error(all), 0.25);
  // The left half and a brick more, and the right half.
  for (const auto& [first, end, from, to] : {std::array{0, 4, 0, 3}, std::array{2, 6, 3, 6}}) {
    const auto beside = depths_beside(first, end);
    const Difference d = difference(part(first, end, beside), first, from, to, all);
    EXPECT_LT(d.mean, 0.03) << first;
    EXPECT_LT(d.sides, 0.003 * d.inside) << first;
    // Were nothing beside it, views would see the other half's silhouettes uncovered, and into the
    // hollow through the other wall.
    const Difference bare = difference(part(first, end, {}), first, from, to, all);
    EXPECT_GT(bare.sides, 3 * d.sides) << first;
  }
}

TEST_F(PartOfBowl, WithoutAHullItIsEmpty) {
  const auto nothing = [](const GridSpec& grid) {
    SparseVolume out;
    out.grid = grid;
    out.table.assign(grid.brick_count(), SparseVolume::kOutside);
    return out;
  };
  const auto beside = depths_beside(0, 3);
  const WholeSurface whole{whole_, ivec3(0), 1, beside};
  const SparseVolume part =
      refine_surface(test::gl_context(),
                     {halved(0, 3), nothing, scene_.silhouettes(), projtex::ImageSet(scene_.views),
                      scene_.cameras, nullptr, nullptr, nullptr, &whole},
                     options_, progress_);
  EXPECT_EQ(part.inside_voxels(), 0u);
  EXPECT_EQ(part.grid.bricks, halved(0, 3).bricks);
}

}  // namespace
}  // namespace photohull::refine
