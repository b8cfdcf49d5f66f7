// What a brick's part of a layer is judged by, for the plane sweep (internal to carving).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "projtex/gpu_views.h"

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

/// A brick, and the views that its part of a layer is judged by.
struct LayerItem {
  static constexpr int kMostViews = 8;

  glm::ivec3 brick{0};
  int view_count = 0;
  std::array<std::uint32_t, kMostViews> views{};  ///< indices, most frontal first
};

/// A brick with the most frontal views that look along the sweep and have it on their image.
LayerItem layer_item(const glm::ivec3& brick, const SweepDirection& direction,
                     std::span<const projtex::GridCamera> cameras);

}  // namespace photohull::carving
