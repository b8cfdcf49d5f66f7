#include "refine/trust.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "projtex/gpu_views.h"

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
                    std::span<const shaders::MatchChoice> choices, std::span<const Camera> cameras,
                    std::span<const carving::Silhouette> silhouettes, const FitOptions& options,
                    std::vector<float>& trust) {
  std::vector<projtex::GridCamera> on_grid;
  for (const Camera& camera : cameras) on_grid.push_back(projtex::to_grid(camera, grid));
  for_surfels(positions.size(), [&](std::size_t i) {
    double share = 1, half_edge = 0;  // voxels
    for (int k = 0; k < choices[i].second.w; ++k) {
      const auto v = std::size_t(k < 4 ? choices[i].first[k] : choices[i].second[k - 4]);
      const projtex::GridCamera& camera = on_grid[v];
      const glm::dvec3 p = camera.projection * glm::dvec4(glm::dvec3(positions[i]), 1);
      if (p.z <= 1) continue;
      const double pixels = camera.focal / p.z;  // per voxel
      if (half_edge == 0)
        half_edge =
            shaders::kMatchRadius * std::max(options.least_spacing, options.pixel_spacing / pixels);
      if (!silhouettes[v].distance) continue;
      const double inside = pixels_inside(*silhouettes[v].distance, glm::dvec2(p) / p.z);
      share = std::min(share, std::max(inside / (half_edge * pixels), 0.0));
    }
    trust[i] *= float(share * share);
  });
}

}  // namespace photohull::refine
