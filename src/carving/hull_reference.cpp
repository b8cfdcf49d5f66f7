// Double-precision references of the visual-hull kernels, written from the definition.
#include <algorithm>
#include <cmath>
#include <optional>

#include "carving/hull.h"
#include "core/error.h"

namespace photohull::carving::reference {
namespace {

struct Rectangle {
  glm::dvec2 low{1e300}, high{-1e300};
};

/// Nothing when a corner is not in front of the camera.
std::optional<Rectangle> project_cube(const GridSpec& grid, const Camera& camera,
                                      const glm::dvec3& low, const glm::dvec3& high) {
  Rectangle r;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 voxel((corner & 1) ? high.x : low.x, (corner & 2) ? high.y : low.y,
                           (corner & 4) ? high.z : low.z);
    const auto pixel = camera.project(grid.world(voxel));
    if (!pixel) return std::nullopt;
    r.low = glm::min(r.low, *pixel);
    r.high = glm::max(r.high, *pixel);
  }
  return r;
}

double coverage(const Silhouette& s, int x, int y) {
  if (!s.mask || s.mask->empty()) return 1;
  return s.mask->coverage[std::size_t(y) * s.mask->width + x] / 255.0;
}

double bilinear_distance(const Silhouette& s, const glm::dvec2& pixel) {
  if (!s.distance) return -double(SilhouetteDistance::kNoContour);
  const SilhouetteDistance& d = *s.distance;
  const double fx = std::floor(pixel.x), fy = std::floor(pixel.y);
  double sum = 0;
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      const int x = std::clamp(int(fx) + dx, 0, d.width - 1);
      const int y = std::clamp(int(fy) + dy, 0, d.height - 1);
      const double wx = dx ? pixel.x - fx : 1 - (pixel.x - fx);
      const double wy = dy ? pixel.y - fy : 1 - (pixel.y - fy);
      sum += wx * wy * d.pixels[std::size_t(y) * d.width + x];
    }
  return sum;
}

}  // namespace

NodeClass classify_node(const GridSpec& grid, const Box& box, std::span<const Camera> cameras,
                        std::span<const Silhouette> silhouettes, const HullOptions& options,
                        const glm::ivec3& low_voxel, int edge, double margin) {
  const glm::dvec3 low = glm::dvec3(low_voxel) - 0.5 - margin;
  const glm::dvec3 high = glm::dvec3(low_voxel) + double(edge) - 0.5 + margin;
  const glm::dvec3 box_low = (box.min - grid.origin) / grid.voxel_size;
  const glm::dvec3 box_high = (box.max - grid.origin) / grid.voxel_size;
  if (glm::any(glm::greaterThan(low, box_high)) || glm::any(glm::lessThan(high, box_low)))
    return NodeClass::kOutside;
  bool inside = glm::all(glm::greaterThanEqual(low, box_low)) &&
                glm::all(glm::lessThanEqual(high, box_high));
  int partly_seen = 0, wholly_seen = 0;
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const Intrinsics& k = cameras[v].intrinsics;
    const auto r = project_cube(grid, cameras[v], low, high);
    if (!r) {
      ++partly_seen;
      inside = false;
      continue;
    }
    const int x0 = std::max(0, int(std::floor(r->low.x))), x1 = std::min(k.width - 1, int(std::ceil(r->high.x)));
    const int y0 = std::max(0, int(std::floor(r->low.y))), y1 = std::min(k.height - 1, int(std::ceil(r->high.y)));
    if (x0 > x1 || y0 > y1) continue;
    ++partly_seen;
    const bool whole = cameras[v].on_image(r->low) && cameras[v].on_image(r->high);
    wholly_seen += whole;
    double least = 1, greatest = 0;
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        least = std::min(least, coverage(silhouettes[v], x, y));
        greatest = std::max(greatest, coverage(silhouettes[v], x, y));
      }
    if (whole && greatest < 0.5) return NodeClass::kOutside;
    inside = inside && least >= 0.5;
  }
  if (partly_seen < options.min_views) return NodeClass::kOutside;
  return inside && wholly_seen >= options.min_views ? NodeClass::kInside : NodeClass::kSurface;
}

double hull_distance(const GridSpec& grid, const Box& box, std::span<const Camera> cameras,
                     std::span<const Silhouette> silhouettes, const HullOptions& options,
                     const glm::ivec3& voxel) {
  const double band = SparseVolume::kBand;
  const glm::dvec3 world = grid.world(voxel);
  const glm::dvec3 beyond = glm::max(box.min - world, world - box.max) / grid.voxel_size;
  double value = std::max({beyond.x, beyond.y, beyond.z});
  int seen = 0;
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const auto pixel = cameras[v].project(world);
    if (!pixel || !cameras[v].on_image(*pixel)) continue;
    ++seen;
    const Intrinsics& k = cameras[v].intrinsics;
    const double voxels_per_pixel =
        cameras[v].to_camera(world).z / std::sqrt(std::abs(k.fx * k.fy)) / grid.voxel_size;
    value = std::max(value, bilinear_distance(silhouettes[v], *pixel) * voxels_per_pixel);
  }
  if (options.min_views > 1 && seen < options.min_views) return band;
  return std::clamp(value, -band, band);
}

}  // namespace photohull::carving::reference
