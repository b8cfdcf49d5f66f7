// Private to module raycast: meshes that a tree can be built over.
#pragma once

#include "core/mesh.h"

namespace photohull {

/// Throws Error when the mesh has no triangles or a vertex that is not finite.
void check_mesh(const TriMesh& mesh);

}  // namespace photohull
