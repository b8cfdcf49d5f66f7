// Private to module texture: where charts of two photographs meet.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace photohull::texture {

/// A side of two triangles that have their colours from different planes.
struct Seam {
  std::array<std::uint32_t, 2> faces;
  std::array<std::uint32_t, 2> vertices;  ///< its ends
};

/// Sides between planes, each once, in the order of their first triangle.
std::vector<Seam> find_seams(const TriMesh& mesh,
                             const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                             const std::vector<std::uint32_t>& plane_of_face);

}  // namespace photohull::texture
