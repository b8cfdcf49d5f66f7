#include "refine/vote.h"

#include <gtest/gtest.h>

#include <limits>

#include "bowl_scene.h"
#include "projtex/gpu_views.h"
#include "refine/ray_maps.h"
#include "support/gl_context.h"
#include "volume/cavities.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::ivec3;

template <typename F>
void for_voxels(const GridSpec& grid, F&& f) {
  const ivec3 n = grid.voxels();
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) f(ivec3(x, y, z), grid.world({x, y, z}));
}

SparseVolume vote(const SparseVolume& hull, const std::vector<PreparedView>& views) {
  gpu::Context& context = test::gl_context();
  const projtex::ImageSet images(views);
  const std::vector<Camera> cameras = projtex::cameras_of(views);
  return vote_free_space(context, hull, {images, cameras, 0.01}, {});
}

TEST(VoteFreeSpace, OpensTheHollowAndSparesTheBody) {
  const test::BowlScene& scene = test::bowl_scene();
  const SparseVolume hull = scene.hull(scene.grid(5));
  SparseVolume found = vote(hull, scene.views);
  for_voxels(found.grid, [&](const ivec3& voxel, const dvec3&) {
    ASSERT_GE(found.at(voxel), hull.at(voxel)) << "the hull bounds what is found";
  });
  // A stray ray leaves pockets where no other one has a say; they end as the refinement ends them.
  fill_cavities(found);
  int hollow = 0, opened = 0, body = 0, lost = 0;
  for_voxels(found.grid, [&](const ivec3& voxel, const dvec3& at) {
    const double voxels = test::bowl(at) / found.grid.voxel_size;
    if (test::filled_bowl(at) < 0 && voxels > 1) {
      ++hollow;
      opened += found.at(voxel) > 0;
    }
    if (voxels < -2) {
      ++body;
      lost += found.at(voxel) >= 0;
    }
  });
  ASSERT_GT(hollow, 1000);
  ASSERT_GT(body, 2000);
  EXPECT_GT(opened, 0.9 * hollow);
  EXPECT_LT(lost, 0.002 * body);
}

TEST(VoteFreeSpace, PlainImagesAndFewViewsLeaveTheHull) {
  const test::BowlScene& scene = test::bowl_scene();
  const SparseVolume hull = scene.hull(scene.grid(3));
  std::vector<PreparedView> plain = scene.views;
  for (PreparedView& view : plain)
    std::fill(view.image.bytes.begin(), view.image.bytes.end(), std::uint8_t(120));
  const std::vector<PreparedView> one(scene.views.begin(), scene.views.begin() + 1);
  for (const auto& views : {plain, one}) {
    const SparseVolume found = vote(hull, views);
    int changed = 0;
    for_voxels(found.grid, [&](const ivec3& voxel, const dvec3&) {
      changed += (found.at(voxel) < 0) != (hull.at(voxel) < 0);
    });
    EXPECT_EQ(changed, 0);
  }
}

TEST(VoteFreeSpace, SameDistancesInEveryRun) {
  const test::BowlScene& scene = test::bowl_scene();
  const SparseVolume hull = scene.hull(scene.grid(3));
  EXPECT_EQ(vote(hull, scene.views).distance, vote(hull, scene.views).distance);
}

TEST(VoteFreeSpace, EmptyHull) {
  const test::BowlScene& scene = test::bowl_scene();
  SparseVolume nothing;
  nothing.grid = scene.grid(2);
  nothing.table.assign(nothing.grid.brick_count(), SparseVolume::kOutside);
  EXPECT_EQ(vote(nothing, scene.views).inside_voxels(), 0u);
}

/// Without its first columns and rows.
PreparedView cut(const PreparedView& view, const glm::ivec2& gone) {
  PreparedView out = view;
  Intrinsics& k = out.camera.intrinsics;
  k.width -= gone.x, k.height -= gone.y;
  k.cx -= gone.x, k.cy -= gone.y;
  const std::size_t each = std::size_t(view.image.bytes_per_pixel());
  out.image.width = k.width, out.image.height = k.height;
  out.image.bytes.clear();
  for (int y = gone.y; y < view.image.height; ++y) {
    const auto row = view.image.bytes.begin() +
                     std::ptrdiff_t((std::size_t(y) * view.image.width + gone.x) * each);
    out.image.bytes.insert(out.image.bytes.end(), row, row + std::ptrdiff_t(k.width * each));
  }
  return out;
}

/// Those of a part beside which nothing is.
std::vector<RayMap> rays_of_part(const SparseVolume& hull, const std::vector<PreparedView>& views) {
  const projtex::ImageSet images(views);
  const std::vector<Camera> cameras = projtex::cameras_of(views);
  const DepthMap nothing{glm::ivec2(1), 1e-6f, {std::numeric_limits<float>::infinity()}};
  const std::vector<DepthMap> beside(views.size(), nothing);
  return match_rays(test::gl_context(), hull, {images, cameras, 0.01, beside}, {});
}

/// Share of the rays of `some` that tell the same depth in `all`, which have so many more pixels
/// before their first ones.
double share_alike(const std::vector<RayMap>& some, const std::vector<RayMap>& all,
                   const glm::ivec2& gone) {
  int told = 0, alike = 0;
  for (std::size_t v = 0; v < all.size(); ++v) {
    EXPECT_NEAR(some[v].stride, all[v].stride, 1e-9);
    EXPECT_GT(all[v].stride, 1.5) << "rays that pass through each pixel would be the same anyway";
    const glm::dvec2 strides =
        (some[v].pixel(0, 0) + glm::dvec2(gone) - all[v].pixel(0, 0)) / all[v].stride;
    const glm::ivec2 first(glm::round(strides));
    EXPECT_LT(glm::distance(strides, glm::dvec2(first)), 1e-9);
    EXPECT_EQ(first % 2, glm::ivec2(0)) << "other neighbours are looked at";
    for (int y = 0; y < some[v].height; ++y)
      for (int x = 0; x < some[v].width; ++x) {
        const std::size_t i = std::size_t(y) * some[v].width + x,
                          j = std::size_t(y + first.y) * all[v].width + x + first.x;
        if (!(some[v].weight[i] > 0)) continue;
        ++told;
        alike += all[v].weight[j] > 0 && std::abs(some[v].depth[i] - all[v].depth[j]) < 0.01;
      }
  }
  EXPECT_GT(told, 1000);
  return double(alike) / told;
}

TEST(MatchRays, OfPartsAreTheSameWhereverPhotographsAreCut) {
  const test::BowlScene& scene = test::bowl_scene();
  const SparseVolume hull = scene.hull(scene.grid(3));
  const std::vector<RayMap> all = rays_of_part(hull, scene.views);
  constexpr glm::ivec2 kGone(4);  // texels of the mip levels in use stay as they are
  std::vector<PreparedView> views;
  for (const PreparedView& view : scene.views) views.push_back(cut(view, kGone));
  EXPECT_GT(share_alike(rays_of_part(hull, views), all, kGone), 0.95);
}

TEST(MatchRays, OfPartsAreTheSameWhereverTheirGridsBegin) {
  const test::BowlScene& scene = test::bowl_scene();
  const GridSpec grid = scene.grid(3);
  GridSpec wide = grid;  // about the same middle
  wide.origin -= wide.voxel_size * kBrickEdge;
  wide.bricks += 2;
  EXPECT_GT(share_alike(rays_of_part(scene.hull(grid), scene.views),
                        rays_of_part(scene.hull(wide), scene.views), glm::ivec2(0)),
            0.85);
}

SparseVolume label(const SparseVolume& hull, const std::vector<PreparedView>& views) {
  gpu::Context& context = test::gl_context();
  const projtex::ImageSet images(views);
  const std::vector<Camera> cameras = projtex::cameras_of(views);
  return label_by_votes(context, hull, {images, cameras, 0.01}, {}, {});
}

TEST(LabelByVotes, WhatSilhouettesWouldTellIsFreeToo) {
  const test::BowlScene& scene = test::bowl_scene();
  const SparseVolume box = scene.hull(scene.grid(5), false);
  SparseVolume found = label(box, scene.views);
  fill_cavities(found);
  int body = 0, lost = 0, empty = 0, solid = 0, solid_in_votes = 0;
  const SparseVolume voted = vote(box, scene.views);
  for_voxels(found.grid, [&](const ivec3& voxel, const dvec3& at) {
    ASSERT_GE(found.at(voxel), box.at(voxel));
    const double voxels = test::bowl(at) / found.grid.voxel_size;
    if (voxels < -1 && voxels > -2) ++body, lost += found.at(voxel) >= 0;
    if (voxels > 3 && box.at(voxel) < 0)
      ++empty, solid += found.at(voxel) < 0, solid_in_votes += voted.at(voxel) < 0;
  });
  RecordProperty("lost", lost), RecordProperty("solid", solid);
  ASSERT_GT(body, 1000);
  ASSERT_GT(empty, 5000);
  EXPECT_LT(lost, 0.3 * body);  // nobody sees its foot
  EXPECT_LT(solid, 0.03 * empty);
  EXPECT_LT(solid, 0.2 * solid_in_votes) << "what is unknown was solid";
}

TEST(LabelByVotes, PlainImagesClaimNothing) {
  const test::BowlScene& scene = test::bowl_scene();
  std::vector<PreparedView> plain = scene.views;
  for (PreparedView& view : plain)
    std::fill(view.image.bytes.begin(), view.image.bytes.end(), std::uint8_t(120));
  EXPECT_EQ(label(scene.hull(scene.grid(3), false), plain).inside_voxels(), 0u);
}

}  // namespace
}  // namespace photohull::refine
