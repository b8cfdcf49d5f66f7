#include "carving/object_box.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/photographed.h"
#include "masks/mask_lines.h"
#include "masks/silhouette.h"

namespace photohull::carving {
namespace {

constexpr double kFilled = 0.55;  // of the box's picture by the foreground
constexpr int kCells = 48;        // along the longest side
constexpr int kPasses = 6;
constexpr double kSettled = 0.9;  // of the longest side: no gain in going on

double longest(const glm::dvec3& size) { return std::max({size.x, size.y, size.z}); }

/// The mask with room around its lines, which are the object's, too.
Mask with_lines(const Mask& mask) {
  Mask widened = mask;
  widen_lines(find_lines(mask), widened);
  return widened;
}

/// Longer side of the bounding rectangle of the foreground that was photographed, pixels.
double foreground_size(const PreparedView& view) {
  const Mask mask = with_lines(view.mask);
  int x0 = mask.width, x1 = -1, y0 = mask.height, y1 = -1;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask.coverage[std::size_t(y) * mask.width + x] >= 128 &&
          is_photographed(view.image, x, y)) {
        x0 = std::min(x0, x), x1 = std::max(x1, x);
        y0 = std::min(y0, y), y1 = std::max(y1, y);
      }
  return std::max(x1 - x0, y1 - y0) + 1;
}

/// Longer side of the box's bounding rectangle in the view, pixels; infinite where the box reaches
/// behind the camera.
double picture_size(const Box& box, const Camera& camera) {
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                            i & 4 ? box.max.z : box.min.z);
    const auto pixel = camera.project(corner);
    if (!pixel) return INFINITY;
    low = glm::min(low, *pixel), high = glm::max(high, *pixel);
  }
  return std::max(high.x - low.x, high.y - low.y);
}

/// A view's silhouette.
struct CameraSilhouette {
  const Camera* camera;
  SilhouetteDistance distance;
};

enum class Sight { kNone, kBackground, kPossible };

/// What a view says of the ball of `radius` (world) around a point.
Sight sight(const CameraSilhouette& s, const glm::dvec3& point, double radius) {
  const double depth = s.camera->to_camera(point).z;
  if (!(depth > radius)) return Sight::kNone;
  const auto pixel = s.camera->project(point);
  if (!pixel || !s.camera->on_image(*pixel)) return Sight::kNone;
  const int x = std::clamp(int(std::lround(pixel->x)), 0, s.distance.width - 1);
  const int y = std::clamp(int(std::lround(pixel->y)), 0, s.distance.height - 1);
  const double reach =
      1 + radius * std::max(s.camera->intrinsics.fx, s.camera->intrinsics.fy) / (depth - radius);
  const double d = s.distance.pixels[std::size_t(y) * s.distance.width + x];
  return d > reach ? Sight::kBackground : Sight::kPossible;
}

/// A cell that no view rejects, and how many have it on their images.
struct Cell {
  glm::dvec3 centre;
  std::size_t seen;
};

std::vector<Cell> possible_cells(const Box& box, double cell,
                                 const std::vector<CameraSilhouette>& silhouettes) {
  const glm::ivec3 n = glm::max(glm::ivec3(glm::ceil(box.size() / cell)), glm::ivec3(1));
  std::vector<Cell> cells;
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) {
        Cell c{box.min + cell * (glm::dvec3(x, y, z) + 0.5), 0};
        const bool possible =
            std::all_of(silhouettes.begin(), silhouettes.end(), [&](const CameraSilhouette& s) {
              const Sight found = sight(s, c.centre, 0.5 * std::sqrt(3.0) * cell);
              c.seen += found == Sight::kPossible;
              return found != Sight::kBackground;
            });
        if (possible) cells.push_back(c);
      }
  return cells;
}

std::optional<Box> tighter(const Box& box, const std::vector<CameraSilhouette>& silhouettes) {
  const double cell = longest(box.size()) / kCells;
  const std::vector<Cell> cells = possible_cells(box, cell, silhouettes);
  std::size_t most = 0;
  for (const Cell& c : cells) most = std::max(most, c.seen);
  Box bounds{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (const Cell& c : cells) {
    if (c.seen < std::max<std::size_t>(2, (most + 1) / 2)) continue;
    bounds.min = glm::min(bounds.min, c.centre - 1.5 * cell);
    bounds.max = glm::max(bounds.max, c.centre + 1.5 * cell);
  }
  if (!(bounds.max.x > bounds.min.x)) return std::nullopt;
  return Box{glm::max(bounds.min, box.min), glm::min(bounds.max, box.max)};
}

}  // namespace

bool box_is_oversized(const Box& box, std::span<const PreparedView> views) {
  int masked = 0, small = 0;
  for (const PreparedView& view : views) {
    if (view.mask.empty()) continue;
    ++masked;
    small += foreground_size(view) < kFilled * picture_size(box, view.camera);
    if (box.contains(view.camera.center())) return true;
  }
  return masked > 0 && 2 * small > masked;
}

Box object_box(const Box& box, std::span<const PreparedView> views) {
  std::vector<CameraSilhouette> silhouettes;
  for (const PreparedView& view : views)
    if (!view.mask.empty())
      silhouettes.push_back({&view.camera, silhouette_distance(with_lines(view.mask))});
  if (silhouettes.size() < 2) return box;
  Box best = box;
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto next = tighter(best, silhouettes);
    if (!next) return box;
    const bool settled = longest(next->size()) > kSettled * longest(best.size());
    best = *next;
    if (settled) break;
  }
  return best;
}

}  // namespace photohull::carving
