// Surface that no camera sees.
#pragma once

#include <span>
#include <vector>

#include "core/describe.h"
#include "core/grid.h"
#include "core/mesh.h"
#include "refine/surface.h"

namespace photohull::refine {

struct CloseOptions {
  int rings = 3, belt = 2;
  double longest = 2, thickness = 2;
};

inline void describe(Described& to, CloseOptions& o) {
  to.number("rings", &o.rings, from_to(0, 1000), "edges",
            "half the width up to which unseen patches stay as they are");
  to.number("belt", &o.belt, from_to(0, 1000), "edges",
            "width around wider unseen patches that stays, for their rim would give way bit by "
            "bit");
  to.rule(o.belt <= o.rings, "belt", "must not exceed", "rings");
  to.number("longest", &o.longest, from_to(0, SparseVolume::kBand), "voxels",
            "longest way that a vertex moves at once");
  to.number("thickness", &o.thickness, from_to(0, 1000), "voxels",
            "distance that stays between unseen surface and seen surface before it");
}

/// Displacements (voxels along the normals) of the vertices that are not `seen` towards the
/// membrane spanned by the seen ones around them: what is not seen is closed smoothly, and keeps a
/// wall behind what is.
std::vector<float> close_unseen(const GridSpec& grid, const TriMesh& mesh, const VertexGraph& graph,
                                const std::vector<bool>& seen, const CloseOptions& options);

}  // namespace photohull::refine
