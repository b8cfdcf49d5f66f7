#include "refine/trust.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "projtex/photographs.h"

namespace photohull::refine {
namespace {

template <typename F>
void for_surfels(std::size_t count, F&& f) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 2048), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) f(i);
  });
}

/// How many pixels a point lies inside an outline; below 0: outside.
double pixels_inside(const SilhouetteDistance& s, const glm::dvec2& pixel) {
  const int x = std::clamp(int(std::floor(pixel.x + 0.5)), 0, s.width - 1);
  const int y = std::clamp(int(std::floor(pixel.y + 0.5)), 0, s.height - 1);
  return -double(s.pixels[std::size_t(y) * s.width + x]);
}

}  // namespace

std::vector<float> trust_thickness(const SparseVolume& volume, std::span<const glm::vec3> positions,
                                   std::span<const glm::vec3> normals, double thick) {
  std::vector<float> trust(positions.size());
  for_surfels(positions.size(), [&](std::size_t i) {
    double depth = 1;
    while (depth < thick &&
           volume.at(glm::ivec3(glm::floor(positions[i] - float(depth) * normals[i] + 0.5f))) < 0)
      depth += 1;
    const double share = std::min(depth / thick, 1.0);
    trust[i] = float(share * share);
  });
  return trust;
}

void trust_outlines(const GridSpec& grid, std::span<const glm::vec3> positions,
                    std::span<const ViewChoice> choices, const SilhouetteCones& cones,
                    const FitOptions& options, std::vector<float>& trust) {
  const std::vector<projtex::GridCamera> on_grid = projtex::to_grid(cones.cameras, grid);
  for_surfels(positions.size(), [&](std::size_t i) {
    double share = 1, half_edge = 0;  // voxels
    for (const int v : choices[i].views) {
      const projtex::GridCamera& camera = on_grid[std::size_t(v)];
      const glm::dvec3 p = camera.projection * glm::dvec4(glm::dvec3(positions[i]), 1);
      if (p.z <= 1) continue;
      const double pixels = camera.focal / p.z;  // per voxel
      if (half_edge == 0)
        half_edge = kPatchRadius * std::max(options.least_spacing, options.pixel_spacing / pixels);
      const SilhouetteDistance* distance = cones.silhouettes[std::size_t(v)].distance;
      if (!distance) continue;
      const double inside = pixels_inside(*distance, glm::dvec2(p) / p.z);
      share = std::min(share, std::max(inside / (half_edge * pixels), 0.0));
    }
    trust[i] *= float(share * share);
  });
}

}  // namespace photohull::refine
