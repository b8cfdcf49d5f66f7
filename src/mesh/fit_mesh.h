// Private to module mesh: a simplified mesh brought nearer to the mesh that it stands for.
#pragma once

#include "core/mesh.h"
#include "mesh/simplify_block.h"

namespace photohull {

/// Flips edges and moves vertices of `simple`, which was made from `mesh`, to where the mean square
/// distance from `mesh` is small. What would then be farther than `limits` allows, either way,
/// degenerate or folded moves back. Borders stay.
void fit_mesh(const TriMesh& mesh, const BlockLimits& limits, TriMesh& simple);

}  // namespace photohull
