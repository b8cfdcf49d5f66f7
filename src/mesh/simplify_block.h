// Private to module mesh: simplification of a part of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "mesh/mesh_edges.h"

namespace photohull {

struct BlockLimits {
  double error = 0;    ///< largest distance in either direction, world units
  double spacing = 0;  ///< of the points at which it is measured
};

/// Marks triangles of which a corner is marked, and then their corners, `rings` times.
void mark_rings(const Triangles& triangles, int rings, std::vector<std::uint8_t>& vertices,
                std::vector<std::uint8_t>& marked);

/// Triangles between the block's vertices in place of its own. `kept` holds a flag for each
/// triangle: one that is set stays, and what failed a check is added. The block's border stays.
Triangles simplify_block(const TriMesh& block, const BlockLimits& limits,
                         std::vector<std::uint8_t>& kept);

}  // namespace photohull
