// Checks on cameras that every scene format shares. Internal to io.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>

#include "core/camera.h"

namespace photohull::io {

/// The nearest rotation to a matrix that is orthonormal within 1e-3 (largest element of
/// R^T R - I). Throws Error opening with `where` and `field` for anything else, saying whether it
/// is mirrored, scaled or no rotation at all.
glm::dmat3 checked_rotation(const glm::dmat3& matrix, const std::string& where,
                            std::string_view field);

/// Throws Error opening with `where` unless all of the camera's numbers are finite and its focal
/// lengths and image size are positive.
void check_camera(const Camera& camera, const Distortion& distortion, const std::string& where);

}  // namespace photohull::io
