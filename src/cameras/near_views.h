// Views that see about the same. Internal to cameras.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"

namespace photohull {

/// Of one camera the `count` others that see most alike, nearest first: those that look within
/// `largest_angle` degrees of its direction, by that angle and by the distance between both centres
/// (as a share of how far all centres spread, root mean square). Cameras around an object differ in
/// both alike; those of a drone that looks down differ in place alone.
std::vector<int> nearest_views(std::span<const Camera> cameras, int view, int count,
                               double largest_angle);

}  // namespace photohull
