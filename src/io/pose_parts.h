// Poses and matrices in other programs' conventions. Internal to io.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "io/raw_scene.h"

namespace photohull::io {

/// A matrix from its elements row by row.
glm::dmat3 from_rows(std::span<const double, 9> elements);

/// A pose from a clean world-to-camera rotation and the optical centre in the world.
Pose pose_at(const glm::dmat3& rotation, const glm::dvec3& center);

/// The rotation of a quaternion w x y z. Throws Error opening with `where`
/// when its length is not 1 within a thousandth.
glm::dmat3 rotation_of(std::span<const double, 4> wxyz, const std::string& where);

/// World-to-camera rotations between our axes (y down, z forward) and OpenGL's (y up, z back):
/// turned by half a turn about x, in either direction.
glm::dmat3 turned_about_x(const glm::dmat3& rotation);
glm::dvec3 turned_about_x(const glm::dvec3& translation);

/// Takes a 3x4 projection matrix (rows of four) apart: K with positive focal lengths (skew and
/// unlike ones kept), rotation and translation, whatever the matrix's scale and sign [Hartley04,
/// section 6.2.4]. Throws Error opening with `where` when it is singular or not finite.
Camera camera_of_projection(std::span<const double, 12> rows, const std::string& where);

/// K from its elements row by row, divided by its last one. Throws Error opening with `where` when
/// it is singular or not upper triangular.
Intrinsics intrinsics_of(std::span<const double, 9> rows, const std::string& where);

/// Rows of K [R | t] with pixel positions that are larger by `pixel_center` than ours.
std::array<double, 12> projection_rows(const Camera& camera, double pixel_center);

}  // namespace photohull::io
