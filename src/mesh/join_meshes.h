// Meshes of several grids made one.
#pragma once

#include <vector>

#include "core/mesh.h"

namespace photohull {

/// Appends `from`, whose positions become relative to the origin of `to`. An attribute that only
/// one of them has goes; but where `to` is empty it becomes `from`.
void append_mesh(const TriMesh& from, TriMesh& to);

/// Leaves out of a coarse mesh what a finer one has: triangles whose corners all lie within `reach`
/// (world units, > 0) of a vertex of `fine`, to within half of it. Where the finer surface ends,
/// the coarse one goes on after an overlap of about `reach`. `more`, a number for each vertex of
/// `coarse`, loses those of the dropped ones. The finer mesh's edges are much shorter than `reach`.
void leave_out_covered(const TriMesh& fine, double reach, TriMesh& coarse,
                       std::vector<float>* more = nullptr);

}  // namespace photohull
