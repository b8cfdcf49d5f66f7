// As many triangles as a picture of a mesh needs.
#pragma once

#include <cstddef>

#include "core/mesh.h"
#include "mesh/simplify_mesh.h"

namespace photohull {

/// At most `triangles` of them (fewer or the same, where borders and small pieces allow it), for
/// looking at: no distance from the mesh is promised, which simplify_mesh does, but it is small,
/// for edges collapse by quadrics [GarlandHeckbert97] in meshoptimizer, the flattest first. The
/// vertices of the result are some of the mesh's, in their order and places, with their attributes;
/// the lists of `more` lose the numbers of the others. A mesh that has no more triangles comes back
/// as it is. The same mesh gives the same result.
TriMesh reduce_mesh(const TriMesh& mesh, std::size_t triangles, MoreNumbers more = {});

}  // namespace photohull
