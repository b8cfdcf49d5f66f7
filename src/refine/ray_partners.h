// Private to module refine: the views that a view's rays are matched with.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "core/box.h"
#include "projtex/gpu_views.h"
#include "shared/refine.h"

namespace photohull::refine {

/// For every view itself and then views near it, at angles between them, `nearest` degrees at
/// least, that are seen from the middle of the box (voxels). For a view that stands within the box,
/// from the point on its axis at its viewing depth, and only views that have it on their image.
std::vector<shaders::MatchChoice> choose_partners(std::span<const projtex::GridCamera> cameras,
                                                  const Box& box, double nearest);

}  // namespace photohull::refine
