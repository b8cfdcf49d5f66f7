// Private to module refine: the views that a view's rays are matched with.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "projtex/gpu_views.h"
#include "shared/refine.h"

namespace photohull::refine {

/// For every view itself and then views near it, at angles between them that are seen from `middle`
/// (voxels).
std::vector<shaders::MatchChoice> choose_partners(std::span<const projtex::GridCamera> cameras,
                                                  const glm::dvec3& middle);

}  // namespace photohull::refine
