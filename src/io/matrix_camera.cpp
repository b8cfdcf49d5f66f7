#include "io/matrix_camera.h"

#include <array>

#include "io/camera_checks.h"
#include "io/pose_parts.h"

namespace photohull::io {

Camera camera_of_matrices(const CameraMatrices& matrices, const Distortion& distortion,
                          const glm::ivec2& size, const std::string& where) {
  std::array<double, 9> rows;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rows[std::size_t(3 * row + column)] = matrices.k[column][row];
  Camera camera;
  camera.intrinsics = intrinsics_of(rows, where);
  camera.intrinsics.width = size.x;
  camera.intrinsics.height = size.y;
  camera.cam_from_world = {checked_rotation(matrices.rotation, where, "R"), matrices.translation};
  check_camera(camera, distortion, where);
  return camera;
}

}  // namespace photohull::io
