// L. Shirman, S. Abi-Ezzi, "The cone of normals technique for fast processing of curved patches",
// Computer Graphics Forum 1993.
#include "render/view_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gpu/limits.h"

namespace photohull::render {
namespace {

constexpr float kPi = 3.14159265f;

struct Group {
  glm::vec3 centre{0}, axis{0};
  float radius = 0;    ///< voxels
  float spread = kPi;  ///< radians between the axis and the normal furthest from it
};

Group bound(std::span<const SurfacePoint> vertices) {
  Group group;
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const SurfacePoint& v : vertices) {
    low = glm::min(low, v.position);
    high = glm::max(high, v.position);
    group.axis += v.normal;
  }
  group.centre = 0.5f * (low + high);
  group.radius = 0.5f * glm::distance(low, high);
  const float length = glm::length(group.axis);
  if (!(length > 1e-3f)) return group;
  group.axis /= length;
  float least = 1;
  for (const SurfacePoint& v : vertices) least = std::min(least, glm::dot(group.axis, v.normal));
  group.spread = std::acos(std::clamp(least, -1.0f, 1.0f));
  return group;
}

bool may_face(const Group& group, const glm::vec3& eye, float flattest) {
  const glm::vec3 offset = eye - group.centre;
  const float distance = glm::length(offset);
  if (!(distance > group.radius)) return true;
  const float cosine = glm::dot(offset, group.axis) / distance;
  const float nearest = std::acos(std::clamp(cosine, -1.0f, 1.0f)) - group.spread -
                        std::asin(group.radius / distance);
  return nearest < flattest;
}

}  // namespace

std::size_t listed_batch(std::size_t vertex_bytes, std::size_t most, std::size_t views) {
  constexpr std::size_t kGroup = shaders::kListedPoints;
  const std::size_t group_bytes = std::max(kGroup * vertex_bytes, (views + 1) * 4);
  return kGroup * gpu::batch_size(group_bytes, most / kGroup);
}

std::vector<std::uint32_t> list_views(std::span<const SurfacePoint> vertices,
                                      std::span<const shaders::GpuView> views, float least_cosine) {
  const float flattest = std::acos(least_cosine) + 1e-3f;
  const std::size_t stride = views.size() + 1;
  std::vector<std::uint32_t> lists;
  lists.reserve((vertices.size() / shaders::kListedPoints + 1) * stride);
  for (std::size_t first = 0; first < vertices.size(); first += shaders::kListedPoints) {
    const std::size_t count =
        std::min<std::size_t>(shaders::kListedPoints, vertices.size() - first);
    const Group group = bound(vertices.subspan(first, count));
    const std::size_t header = lists.size();
    lists.resize(header + stride);
    for (std::size_t v = 0; v < views.size(); ++v)
      if (may_face(group, glm::vec3(views[v].centre), flattest))
        lists[header + ++lists[header]] = std::uint32_t(v);
  }
  return lists;
}

}  // namespace photohull::render
