// Where refined cameras' world lies: photographs alone tell it only up to a similarity.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"

namespace photohull {

/// The cameras in a world moved by the similarity that brings the points `from` nearest to `to`
/// [Umeyama91]; three points or more, not on a line.
std::vector<Camera> with_world_moved(std::span<const Camera> cameras,
                                     std::span<const glm::dvec3> from,
                                     std::span<const glm::dvec3> to);

/// The cameras in a world moved by the similarity about `middle` after which the `given` cameras
/// see the points nearest to where these cameras see them: least squares over views and points, in
/// pixels, a view's weight falling with its distance (Cauchy), so that a camera that was far off
/// does not drag the world along. The likeliest world when errors of given cameras are independent
/// and alike in pixels. The cameras as they are where no view sees all points by both.
std::vector<Camera> with_world_as_given(std::span<const Camera> cameras,
                                        std::span<const Camera> given,
                                        std::span<const glm::dvec3> points,
                                        const glm::dvec3& middle);

}  // namespace photohull
