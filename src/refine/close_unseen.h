// Surface that no camera sees.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "refine/surface.h"

namespace photohull::refine {

struct CloseOptions {
  int rings = 3;           ///< edges: unseen patches narrower than twice that stay as they are
  int belt = 2;            ///< edges around the others that stay: the rim would give way bit by bit
  int iterations = 150;    ///< of the Gauss-Seidel method
  double longest = 2.0;    ///< voxels that a vertex moves at once
  double thickness = 2.0;  ///< voxels that stay between unseen surface and seen surface before it
};

/// Displacements (voxels along the normals) of the vertices that are not `seen` towards the
/// membrane spanned by the seen ones around them: what is not seen is closed smoothly, and keeps a
/// wall behind what is.
std::vector<float> close_unseen(const GridSpec& grid, const TriMesh& mesh, const VertexGraph& graph,
                                const std::vector<bool>& seen, const CloseOptions& options);

}  // namespace photohull::refine
