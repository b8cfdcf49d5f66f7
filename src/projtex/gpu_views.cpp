#include "projtex/gpu_views.h"

#include <algorithm>
#include <cmath>

#include "core/viewing_depth.h"

namespace photohull::projtex {

GridCamera to_grid(const Camera& camera, const GridSpec& grid) {
  const Intrinsics& k = camera.intrinsics;
  const glm::dmat4x3 p = camera.projection();
  GridCamera out;
  // P (voxel_size * v + origin): homogeneous, so dividing by voxel_size puts q into voxels.
  for (int column = 0; column < 3; ++column) out.projection[column] = p[column];
  out.projection[3] = (glm::dmat3(p) * grid.origin + p[3]) / grid.voxel_size;
  out.centre = (camera.center() - grid.origin) / grid.voxel_size;
  out.focal = std::sqrt(std::abs(k.fx * k.fy));
  out.width = k.width;
  out.height = k.height;
  return out;
}

double viewing_depth(const GridCamera& camera, const GridSpec& grid) {
  return photohull::viewing_depth(camera.projection, camera.centre, camera.width, camera.height,
                                  grid.frame());
}

shaders::GpuView to_gpu_view(const GridCamera& camera, const glm::ivec2& array_size,
                             double sharpness) {
  const auto row = [&](int r) {
    const glm::dmat4x3& p = camera.projection;
    return glm::vec4(p[0][r], p[1][r], p[2][r], p[3][r]);
  };
  return {row(0),
          row(1),
          row(2),
          glm::vec4(glm::vec3(camera.centre), float(camera.focal)),
          glm::vec4(camera.width, camera.height, 1.0f / float(array_size.x),
                    1.0f / float(array_size.y)),
          glm::vec4(sharpness, 0, 0, 0)};
}

glm::ivec2 array_size(std::span<const Camera> cameras, int cut_at) {
  glm::ivec2 size(1);
  for (const Camera& c : cameras)
    size = glm::max(size, glm::ivec2(c.intrinsics.width, c.intrinsics.height));
  return cut_at * ((size + cut_at - 1) / cut_at);
}

std::vector<Camera> cameras_of(std::span<const PreparedView> views) {
  std::vector<Camera> cameras;
  for (const PreparedView& view : views) cameras.push_back(view.camera);
  return cameras;
}

}  // namespace photohull::projtex
