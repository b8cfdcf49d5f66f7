// The views that surfels are matched in (refine_choose_views.comp.glsl).
#pragma once

#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "gpu/context.h"
#include "projtex/photographs.h"
#include "refine/match.h"
#include "refine/view_choice.h"

namespace photohull::refine {

/// The views that each vertex of `mesh` (with normals) is matched in, sharp ones first where
/// others are blurred (reference::choose_views). Visibility by depth maps of the mesh itself.
/// Throws Error when the device cannot hold a batch.
std::vector<ViewChoice> choose_views(gpu::Context& context, const GridSpec& grid,
                                     const TriMesh& mesh, const projtex::Photographs& photographs,
                                     const MatchOptions& options);

}  // namespace photohull::refine
