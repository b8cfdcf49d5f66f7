// How far away a camera looks at what is in a box.
#pragma once

#include <glm/glm.hpp>

#include "core/box.h"

namespace photohull {

/// Depth (linear, along the optical axis) that stands for all of a box: its middle's, for a camera
/// that stands outside and has it on its image. For others, no less than the depth at which rays
/// through their image leave the box (the median). `projection` takes (x, 1) to homogeneous
/// pixels whose third coordinate is the depth; `centre` is the camera's; all in the box's units.
/// Not positive for a camera outside that looks away.
double viewing_depth(const glm::dmat4x3& projection, const glm::dvec3& centre, int width,
                     int height, const Box& box);

}  // namespace photohull
