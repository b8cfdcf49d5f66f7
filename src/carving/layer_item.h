// What a brick's part of a layer is judged by, for the plane sweep (internal to carving).
#pragma once

#include <span>

#include "projtex/gpu_views.h"
#include "shared/sweep.h"

namespace photohull::carving {

/// Of a sweep: along an axis of the grid, upwards (+1) or downwards (-1).
struct SweepDirection {
  int axis = 0, sign = 1;
};

/// Below which a camera does not look along the sweep.
inline constexpr double kLeastSweepCosine = 0.35;

/// Cosine between the sweep and the direction from the camera to a point (voxels).
double sweep_cosine(const projtex::GridCamera& camera, const glm::dvec3& point,
                    const SweepDirection& direction);

/// A brick with the most frontal views that look along the sweep and have it on their image.
shaders::LayerItem layer_item(const glm::ivec3& brick, const SweepDirection& direction,
                              std::span<const projtex::GridCamera> cameras);

}  // namespace photohull::carving
