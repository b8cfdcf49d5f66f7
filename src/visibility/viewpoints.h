// Cameras for maps: of a light, or of whatever looks at a whole object.
#pragma once

#include <vector>

#include "core/camera.h"

namespace photohull::visibility {

/// A camera at `eye` towards `target` that has a sphere of `radius` around it in view.
Camera frame_sphere(const glm::dvec3& eye, const glm::dvec3& target, double radius, int width,
                    int height);

/// Six square cameras at `eye` that see all directions, a little more than 90 degrees each.
std::vector<Camera> look_around(const glm::dvec3& eye, int texels);

}  // namespace photohull::visibility
