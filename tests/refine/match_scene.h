// Photographs for the matching kernels, and what their references need of them.
#pragma once

#include <vector>

#include "core/mesh.h"
#include "refine/match_reference.h"
#include "refine/view_choice.h"
#include "render/bake_colour.h"
#include "render/surface_points.h"
#include "support/ray_cast.h"

namespace photohull::test {

inline const GridSpec kGrid{{3, -2, 7}, 0.05, {6, 6, 6}};
inline constexpr int kImageEdge = 64;  ///< a power of two, as the reference's mip chains need
inline constexpr double kNoise = 0.01;

/// Views of random pixels from all around the grid, the last one amid it; every third one smaller
/// than the array texture.
inline std::vector<PreparedView> random_views(Rng& rng, int count) {
  std::vector<PreparedView> views;
  const Box box = kGrid.bounds();
  for (int i = 0; i < count; ++i) {
    const int width = i % 3 == 2 ? 48 : kImageEdge, height = i % 3 == 2 ? 40 : kImageEdge;
    PreparedView view;
    view.camera = i + 1 < count ? random_camera(rng, box, width, height)
                                : look_at(box.center(), box.max, 60, width, height);
    view.image = random_image(rng, width, height);
    views.push_back(std::move(view));
  }
  return views;
}

inline std::vector<refine::reference::MatchView> reference_views(
    const std::vector<PreparedView>& views) {
  std::vector<refine::reference::MatchView> out;
  for (const PreparedView& view : views)
    out.push_back({projtex::to_grid(view.camera, kGrid),
                   {},
                   {},
                   projtex::reference::mip_chain(view.image, {kImageEdge, kImageEdge}),
                   std::min(view.sharpness / 0.9, 1.0)});
  return out;
}

/// Draws a mesh of vertices only into the reference's depth maps.
inline void draw(const std::vector<PreparedView>& views, const TriMesh& mesh,
                 std::vector<refine::reference::MatchView>& out) {
  const visibility::DepthMaps maps = render::occluder_maps(projtex::cameras_of(views), kGrid);
  for (std::size_t i = 0; i < out.size(); ++i) {
    render::reference::BakeView view{out[i].camera, maps.infos()[i], {}, nullptr};
    view.depths.assign(std::size_t(view.depth_info.size.x) * view.depth_info.size.y, 1e30);
    for (const auto& v : render::to_voxels(kGrid, mesh))
      render::reference::splat_point(glm::dvec3(v.position), glm::dvec3(v.normal), view);
    out[i].depth_info = view.depth_info;
    out[i].depths = std::move(view.depths);
  }
}

/// Points strewn over the grid; every tenth has no normal.
inline TriMesh random_points(Rng& rng, int count) {
  TriMesh mesh;
  mesh.origin = kGrid.bounds().center();
  const Box box{kGrid.bounds().min - mesh.origin, kGrid.bounds().max - mesh.origin};
  for (int i = 0; i < count; ++i) {
    mesh.positions.emplace_back(uniform_in(rng, box));
    mesh.normals.emplace_back(i % 10 ? random_direction(rng) : glm::dvec3(0));
  }
  return mesh;
}

/// One vertex at a position in voxel coordinates.
inline void add_vertex(const glm::dvec3& voxel, const glm::dvec3& normal, TriMesh& mesh) {
  mesh.origin = kGrid.bounds().center();
  mesh.positions.emplace_back(kGrid.world(voxel) - mesh.origin);
  mesh.normals.emplace_back(normal);
}

inline std::vector<int> views_of(const refine::ViewChoice& choice) {
  return {choice.views.begin(), choice.views.end()};
}

inline refine::ViewChoice choice_of(const std::vector<int>& views) {
  refine::ViewChoice out;
  out.views = refine::ViewList<refine::ViewChoice::kMostViews>(views);
  return out;
}

}  // namespace photohull::test
