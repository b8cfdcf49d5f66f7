// Cameras of programs that have them as matrices.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "core/camera.h"

namespace photohull::io {

/// The matrices of a camera: pixel ~ K (R x + t), with pixels, world and camera as core/camera.h
/// has them.
struct CameraMatrices {
  glm::dmat3 k{1.0};         ///< upper triangular; divided by its last element
  glm::dmat3 rotation{1.0};  ///< cam_from_world, orthonormal within 1e-3
  glm::dvec3 translation{0.0};
};

/// The camera of a photograph of `size` pixels; its rotation is the nearest exact one. Throws Error
/// opening with `where` for matrices that are no camera's, and numbers that are not finite.
Camera camera_of_matrices(const CameraMatrices& matrices, const Distortion& distortion,
                          const glm::ivec2& size, const std::string& where);

}  // namespace photohull::io
