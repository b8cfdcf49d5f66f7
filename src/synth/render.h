// Photographs of a surface without a camera's faults.
#pragma once

#include <functional>
#include <vector>

#include "synth/lens.h"
#include "synth/light_maps.h"
#include "synth/shading.h"

namespace photohull::synth {

/// One view, row-major from the top-left.
struct Picture {
  int width = 0, height = 0;
  std::vector<glm::vec3> colour;  ///< linear light, averaged over the pixel's area
  std::vector<float> coverage;    ///< share of the pixel's area that the object covers
  std::vector<float> depth;       ///< at the pixel's centre, world units; 0: nothing there
  std::vector<glm::vec3> normal;  ///< at the pixel's centre, world, unit, towards the camera; or 0
};

/// Traces samples x samples rays a pixel, stratified with a jitter that depends on seed, view and
/// pixel only. `row_done` is called after every row, from several threads; what it throws ends
/// the work. With `maps` shadows come from them, else from rays; they belong to the calling thread.
Picture render(
    const Surface& surface, const Shading& shading, const LensCamera& lens, std::size_t view,
    int samples, std::uint64_t seed, const std::function<void()>& row_done = [] {},
    LightMaps* maps = nullptr);

/// The same view without the object: one look at the background a pixel.
Picture render_background(const Shading& shading, const LensCamera& lens, std::size_t view);

}  // namespace photohull::synth
