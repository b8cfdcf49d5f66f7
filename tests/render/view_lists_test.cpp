#include "render/view_lists.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "projtex/gpu_views.h"
#include "render/meshes.h"
#include "render/surface_points.h"
#include "shared/bake.h"
#include "support/cameras.h"

namespace photohull::render {
namespace {

const GridSpec kGrid{{-1.5, -1.5, -1.5}, 0.05, {8, 8, 8}};

std::vector<shaders::GpuView> views_around(int count) {
  std::vector<shaders::GpuView> views;
  for (const Camera& c : test::cameras_around({0, 0, 0}, 3, count, 100, 64, 64))
    views.push_back(projtex::to_gpu_view(projtex::to_grid(c, kGrid), {64, 64}));
  return views;
}

bool faces(const SurfacePoint& vertex, const shaders::GpuView& view) {
  const glm::vec3 offset = glm::vec3(view.centre) - vertex.position;
  return glm::dot(glm::normalize(offset), vertex.normal) > shaders::kBakeMinCosine;
}

/// Every view that a vertex faces must be on the list of its group; returns the entries of all.
std::size_t check_lists(const std::vector<SurfacePoint>& vertices,
                        const std::vector<shaders::GpuView>& views) {
  const auto lists = list_views(vertices, views, shaders::kBakeMinCosine);
  const std::size_t stride = views.size() + 1;
  std::size_t entries = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto list = lists.begin() + long(i / shaders::kListedPoints * stride);
    if (i % shaders::kListedPoints == 0) entries += *list;
    for (std::size_t v = 0; v < views.size(); ++v) {
      const bool listed = std::find(list + 1, list + 1 + long(*list), v) != list + 1 + long(*list);
      EXPECT_TRUE(listed || !faces(vertices[i], views[v])) << "vertex " << i << ", view " << v;
    }
  }
  return entries;
}

TEST(ViewLists, HoldTheViewsThatVerticesFaceAndFewOthers) {
  const auto vertices = to_voxels(kGrid, test::sphere_mesh({0, 0, 0}, 1, 128));
  const auto views = views_around(30);
  const std::size_t groups = vertices.size() / shaders::kListedPoints + 1;
  EXPECT_LT(check_lists(vertices, views), 0.75 * double(groups * views.size()));
}

TEST(ViewLists, StrewnVerticesAndMissingNormals) {
  test::Rng rng(3);
  std::vector<SurfacePoint> vertices;
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 position(test::uniform_in(rng, {{0, 0, 0}, {63, 63, 63}}));
    const glm::vec3 normal(i % 3 ? test::random_direction(rng) : glm::dvec3(0));
    vertices.push_back({position, normal});
  }
  check_lists(vertices, views_around(12));
}

}  // namespace
}  // namespace photohull::render
