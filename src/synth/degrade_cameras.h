// Cameras as calibration gets them wrong.
#pragma once

#include <vector>

#include "synth/lens.h"
#include "synth/random.h"
#include "synth/spec.h"

namespace photohull::synth {

/// Root mean square distance, over points and views, between a point's pixels in two sets of
/// cameras. Points behind a camera do not count.
double reprojection_error(const std::vector<LensCamera>& a, const std::vector<LensCamera>& b,
                          const std::vector<glm::dvec3>& points);

/// The cameras with errors of exactly the asked sizes over the points: poses turned and moved at
/// random, each view by itself; focal length and principal point off by the same amounts in all
/// views; with both, each is of its size by itself. Then a share of the views is turned about the
/// middle of the points, the principal points of another share are shifted by view_shift each in a
/// direction of its own, all principal points are shifted, and distortion is forgotten.
std::vector<LensCamera> degrade_cameras(const std::vector<LensCamera>& cameras,
                                        const DegradationSpec& spec, std::uint64_t seed,
                                        const std::vector<glm::dvec3>& points);

/// Do the written cameras differ from the exact ones?
bool cameras_are_off(const DegradationSpec& spec);

/// 0 to count - 1, shuffled.
std::vector<std::size_t> random_order(std::size_t count, Random random);

}  // namespace photohull::synth
