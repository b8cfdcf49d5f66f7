// Points from their pixels.
#pragma once

#include <optional>
#include <span>

#include "cameras/feature_tracks.h"

namespace photohull {

/// The point whose projections are nearest to the observations, by Gauss-Newton from where the rays
/// pass each other nearest [Hartley04, chapter 12]. Nothing where rays are parallel within a
/// thousandth of a radian or the point is behind a camera.
std::optional<glm::dvec3> triangulate(std::span<const Camera> cameras, const Track& track);

/// Root mean square distance of the observations from the projections of a point, pixels; infinite
/// behind a camera.
double reprojection_rms(std::span<const Camera> cameras, const Track& track,
                        const glm::dvec3& point);

}  // namespace photohull
