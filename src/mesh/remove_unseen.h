// Surface that no camera sees, left out of a mesh.
#pragma once

#include "core/mesh.h"
#include "mesh/simplify_mesh.h"

namespace photohull {

/// The mesh without the parts that nobody sees, or that are more in doubt than `least_confidence`:
/// triangles whose three corners have confidence 0, or one below the least. Patches of fewer than
/// kLeastPatch triangles stay, for they are gaps between pixels and not sides that nobody
/// photographed; islands of fewer that removal would leave go, and so do triangles left hanging by
/// one edge. Vertices that are left keep their attributes and order; the border may have vertices
/// of confidence 0. A mesh without confidence comes back as it is.
/// The lists of `more` lose the numbers of the vertices that go.
TriMesh remove_unseen(const TriMesh& mesh, double least_confidence = 0, MoreNumbers more = {});

constexpr int kLeastPatch = 32;

}  // namespace photohull
