#include "render/kernels/device_points.h"

#include <vector>

#include "shared/surface_points.h"

namespace photohull::render {

gpu::Buffer to_device(std::span<const SurfacePoint> points) {
  std::vector<shaders::SurfacePoint> out;
  out.reserve(points.size());
  for (const SurfacePoint& point : points)
    out.push_back({glm::vec4(point.position, 0), glm::vec4(point.normal, 0)});
  return gpu::Buffer::of(out);
}

}  // namespace photohull::render
