// What the cameras can know of the surface.
#pragma once

#include <functional>
#include <vector>

#include "synth/lens.h"
#include "synth/surface.h"

namespace photohull::synth {

/// A point of the surface.
struct TruthSample {
  glm::dvec3 position;      ///< world
  glm::vec3 normal;         ///< of its triangle; unit, outward
  std::uint16_t views = 0;  ///< cameras that see it
};

/// Points spread evenly by area: one at random in each of `count` equal shares of the surface, in
/// the order of its triangles.
std::vector<TruthSample> sample_surface(const Surface& surface, int count, std::uint64_t seed);

/// Counts the cameras that see each sample: in front, inside the frame (lens distortion included),
/// on the side that the triangle shows, and with nothing in between, by exact ray casting from
/// 1e-5 diagonals above the surface.
/// `part_done` gets the share done, from several threads; what it throws ends the work.
void count_views(
    const Surface& surface, const std::vector<LensCamera>& cameras,
    std::vector<TruthSample>& samples,
    const std::function<void(double)>& part_done = [](double) {});

}  // namespace photohull::synth
