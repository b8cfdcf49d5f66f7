// Meshes of several grids made one.
#pragma once

#include "core/mesh.h"
#include "mesh/simplify_mesh.h"

namespace photohull {

/// Appends `from`, whose positions become relative to the origin of `to`. An attribute that only
/// one of them has goes; but where `to` is empty it becomes `from`.
void append_mesh(const TriMesh& from, TriMesh& to);

/// Leaves out of a coarse mesh what a finer one has: triangles whose corners all lie within `reach`
/// (world units, > 0) of a vertex of `fine`, to within half of it. Where the finer surface ends,
/// the coarse one goes on after an overlap of about `reach`. The lists of `more`, of
/// the vertices of `coarse`, lose the numbers of the dropped ones. The finer mesh's edges are much
/// shorter than `reach`.
void leave_out_covered(const TriMesh& fine, double reach, TriMesh& coarse, MoreNumbers more = {});

}  // namespace photohull
