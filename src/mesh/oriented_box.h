// Small boxes around points.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "mesh/measure.h"

namespace photohull {

/// A box around the points whose volume is small: of the boxes that lie flat on one of the convex
/// hull's largest faces, or on its sides along the world's axes, and around the other two axes on
/// an edge of what is seen along it, the one of least volume. Flat or empty where the points are.
OrientedBox oriented_box(std::span<const glm::dvec3> points);

}  // namespace photohull
