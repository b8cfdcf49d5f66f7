// Private to module mesh: vertices of a simplified mesh moved.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "mesh/flip_edges.h"

namespace photohull {

/// Moves, world units, one for each vertex of `simple`, after which the planes of its triangles are
/// nearest to the points that belong to them, in the mean square. Vertices flagged in `fixed` stay;
/// no other moves farther than `most`.
std::vector<glm::dvec3> fit_vertices(const std::vector<FitPoint>& points, const TriMesh& simple,
                                     const std::vector<std::uint8_t>& fixed, double most);

}  // namespace photohull
