// Double-precision references of the visual-hull kernels, written from the definition.
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "carving/hull.h"
#include "core/error.h"

namespace photohull::carving::reference {
namespace {

using Polygon = std::vector<glm::dvec2>;

/// Turn from a to b to c: positive when left (y up).
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Convex hull by monotone chains, its corners in order.
Polygon convex_hull(Polygon points) {
  std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  Polygon hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const glm::dvec2& p : points) {
      while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // begins the other chain
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// 0 inside.
double distance_to(const Polygon& convex, const glm::dvec2& p) {
  bool inside = true;
  double nearest = 1e300;
  for (std::size_t i = 0; i < convex.size(); ++i) {
    const glm::dvec2 a = convex[i], ab = convex[(i + 1) % convex.size()] - a;
    inside = inside && turn(a, a + ab, p) >= 0;
    const double t = std::clamp(glm::dot(p - a, ab) / std::max(glm::dot(ab, ab), 1e-300), 0.0, 1.0);
    nearest = std::min(nearest, glm::length(p - a - t * ab));
  }
  return inside ? 0 : nearest;
}

enum class Place { kBehind, kStraddling, kInFront };

struct ProjectedCube {
  Place place = Place::kStraddling;
  Polygon outline;  ///< when in front
  glm::dvec2 low{1e300}, high{-1e300};
};

ProjectedCube project_cube(const GridSpec& grid, const Camera& camera, const glm::dvec3& low,
                           const glm::dvec3& high) {
  ProjectedCube cube;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 voxel((corner & 1) ? high.x : low.x, (corner & 2) ? high.y : low.y,
                           (corner & 4) ? high.z : low.z);
    if (const auto pixel = camera.project(grid.world(voxel))) cube.outline.push_back(*pixel);
  }
  if (cube.outline.empty()) cube.place = Place::kBehind;
  if (cube.outline.size() < 8) return cube;
  cube.place = Place::kInFront;
  cube.outline = convex_hull(cube.outline);
  for (const glm::dvec2& p : cube.outline) {
    cube.low = glm::min(cube.low, p);
    cube.high = glm::max(cube.high, p);
  }
  return cube;
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

bool touches_image(const Camera& camera, const ProjectedCube& cube) {
  const Intrinsics& k = camera.intrinsics;
  return cube.high.x >= -0.5 && cube.high.y >= -0.5 && cube.low.x <= k.width - 0.5 &&
         cube.low.y <= k.height - 0.5;
}

/// Least and greatest coverage of the pixels within `margin` pixels of the cube's projection: with
/// one, those that a bilinear look-up there can use.
glm::dvec2 coverage_range(const Silhouette& silhouette, const Intrinsics& k,
                          const ProjectedCube& cube, double margin) {
  const glm::dvec2 size(k.width, k.height);
  const glm::ivec2 first(glm::max(glm::floor(cube.low - margin), glm::dvec2(0)));
  const glm::ivec2 last(glm::min(glm::ceil(cube.high + margin), size - 1.0));
  glm::dvec2 range(1, 0);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      if (distance_to(cube.outline, {x, y}) > margin) continue;
      const double c = coverage(silhouette, x, y);
      range = {std::min(range.x, c), std::max(range.y, c)};
    }
  return range;
}

/// What a view says of a point, voxels: its distance from the outline, and that at which the view's
/// evidence is full.
struct Said {
  double distance = 0, full = 0;
};

/// The distance that is farthest outside of those at which the evidence sums to one, by bisection;
/// the definition.
double distance_by_evidence(const std::vector<Said>& said) {
  double low = 1e30, high = -1e30;
  for (const Said& s : said)
    low = std::min(low, s.distance - s.full), high = std::max(high, s.distance);
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    double evidence = 0;
    for (const Said& s : said) evidence += std::clamp((s.distance - middle) / s.full, 0.0, 1.0);
    (evidence >= 1 ? low : high) = middle;
  }
  return low;
}

}  // namespace

NodeClass classify_node(const HullSpace& space, const HullViews& views, const HullOptions& options,
                        const NodeCube& node) {
  const auto& [grid, box] = space;
  const auto& [cameras, silhouettes] = views;
  const glm::dvec3 low = glm::dvec3(node.low) - 0.5 - node.margin;
  const glm::dvec3 high = glm::dvec3(node.low) + double(node.edge) - 0.5 + node.margin;
  const glm::dvec3 box_low = (box.min - grid.origin) / grid.voxel_size;
  const glm::dvec3 box_high = (box.max - grid.origin) / grid.voxel_size;
  if (glm::any(glm::greaterThan(low, box_high)) || glm::any(glm::lessThan(high, box_low)))
    return NodeClass::kOutside;
  bool inside =
      glm::all(glm::greaterThanEqual(low, box_low)) && glm::all(glm::lessThanEqual(high, box_high));
  int partly_seen = 0, wholly_seen = 0, rejecting = 0, doubting = 0;
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const ProjectedCube cube = project_cube(grid, cameras[v], low, high);
    if (cube.place == Place::kStraddling) {
      ++partly_seen;
      inside = false;
    }
    if (cube.place != Place::kInFront || !touches_image(cameras[v], cube)) continue;
    ++partly_seen;
    const bool whole = cameras[v].on_image(cube.low) && cameras[v].on_image(cube.high);
    wholly_seen += whole;
    // One pixel for the look-up's; the rest is what one view alone needs to reject a point.
    const glm::dvec2 range =
        coverage_range(silhouettes[v], cameras[v].intrinsics, cube, 1 + options.full_evidence);
    rejecting += whole && range.y < 0.5;
    doubting += range.x < 0.5;
  }
  if (rejecting > options.views_may_miss) return NodeClass::kOutside;
  inside = inside && doubting <= options.views_may_miss;
  if (partly_seen < options.min_views) return NodeClass::kOutside;
  return inside && wholly_seen >= options.min_views ? NodeClass::kInside : NodeClass::kSurface;
}

double hull_distance(const HullSpace& space, const HullViews& views, const HullOptions& options,
                     const glm::ivec3& voxel) {
  const auto& [grid, box] = space;
  const auto& [cameras, silhouettes] = views;
  const double band = SparseVolume::kBand;
  const glm::dvec3 world = grid.world(voxel);
  const glm::dvec3 beyond = glm::max(box.min - world, world - box.max) / grid.voxel_size;
  std::vector<double> said;
  std::vector<Said> evidence;
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const auto pixel = cameras[v].project(world);
    if (!pixel || !cameras[v].on_image(*pixel)) continue;
    const Intrinsics& k = cameras[v].intrinsics;
    const double voxels_per_pixel =
        cameras[v].to_camera(world).z / std::sqrt(std::abs(k.fx * k.fy)) / grid.voxel_size;
    said.push_back(bilinear_distance(silhouettes[v], *pixel) * voxels_per_pixel);
    evidence.push_back({said.back(), options.full_evidence * voxels_per_pixel});
  }
  if (int(said.size()) < options.min_views) return band;
  std::sort(said.begin(), said.end(), std::greater<>());
  const auto missing = std::size_t(options.views_may_miss);
  double silhouettes_say = missing < said.size() ? said[missing] : -1e30;
  if (options.full_evidence > 0 && !evidence.empty())
    silhouettes_say = distance_by_evidence(evidence);
  return std::clamp(std::max({beyond.x, beyond.y, beyond.z, silhouettes_say}), -band, band);
}

}  // namespace photohull::carving::reference
