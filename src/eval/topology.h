// Which triangles of a mesh meet; private to this module.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace photohull::eval {

/// For each vertex the lowest index of a vertex at exactly the same position.
std::vector<std::uint32_t> joined_vertices(const TriMesh& mesh);

/// A side of a triangle: from its corner `side` to the next.
struct HalfEdge {
  std::uint64_t key = 0;  ///< the joined indices of its ends, the lower one in the high half
  std::uint32_t triangle = 0;
  std::uint8_t side = 0;
  bool ascending = false;  ///< runs from the lower index to the higher
};

/// All sides of all triangles, those between the same two positions together; sides without length
/// are left out.
std::vector<HalfEdge> sorted_half_edges(const TriMesh& mesh,
                                        const std::vector<std::uint32_t>& joined);

/// Triangles that have an area, of a mesh with the same vertices.
TriMesh without_degenerate_faces(const TriMesh& mesh);

/// Twice the area times the unit normal, in world units.
glm::dvec3 area_vector(const TriMesh& mesh, std::size_t triangle);

}  // namespace photohull::eval
