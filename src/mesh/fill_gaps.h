// Private to module mesh: gaps between parts of one surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/mesh.h"
#include "mesh/mesh_edges.h"

namespace photohull {

/// The part of a vertex that several parts have.
constexpr std::uint32_t kSeam = std::numeric_limits<std::uint32_t>::max();

/// Fills the gaps between parts that sides of the mesh which no triangle runs along the other way
/// (`open`) go around, and returns how many there were: those whose two parts are near each other
/// all along. `parts`: of the vertices. `reach`: as of stitch_rims.
std::size_t fill_gaps(const std::vector<Side>& open, const std::vector<std::uint32_t>& parts,
                      double reach, TriMesh& mesh);

}  // namespace photohull
