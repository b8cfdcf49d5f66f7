#include "carving/thin_parts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "carving/join_parts.h"
#include "masks/outline_probe.h"
#include "projtex/gpu_views.h"

namespace photohull::carving {
namespace {

using glm::dvec3;
using glm::ivec3;

constexpr float kReach = 0.87f;   // voxels from a voxel's centre to its corners
constexpr float kOnSlope = 0.5f;  // drop to a neighbour that the boundary of a thick part has
constexpr int kBeside = 2;        // pixels from a line
constexpr int kFewestViews = 3;   // that show a stem
constexpr double kFirstStep = 0.25, kLastStep = 0.05;  // of the search within a voxel

/// The silhouettes in the lattice's frame.
class Field {
 public:
  Field(const GridSpec& grid, const Box& box, std::span<const Camera> cameras,
        std::span<const Silhouette> silhouettes, const HullOptions& options)
      : low_((box.min - grid.origin) / grid.voxel_size),
        high_((box.max - grid.origin) / grid.voxel_size),
        least_views_(options.min_views),
        missing_(options.views_may_miss),
        full_evidence_(options.full_evidence) {
    for (std::size_t v = 0; v < cameras.size(); ++v) {
      const projtex::GridCamera camera = projtex::to_grid(cameras[v], grid);
      views_.push_back({{camera.projection, camera.width, camera.height, silhouettes[v].distance},
                        1 / camera.focal,
                        beside_lines(silhouettes[v])});
    }
    std::stable_partition(views_.begin(), views_.end(),
                          [](const View& v) { return !v.beside_lines.empty(); });
  }

  bool has_lines() const {
    return std::any_of(views_.begin(), views_.end(),
                       [](const View& v) { return !v.beside_lines.empty(); });
  }

  /// Does the point fall beside lines in a third of the views that see it, and in some at least?
  bool on_stem(const dvec3& p) const {
    int seen = 0, beside = 0;
    Appearance at;
    for (const View& view : views_) {
      if (view.beside_lines.empty() && beside < kFewestViews) return false;  // the rest has none
      if (!view.probe.sees(p, at)) continue;
      ++seen;
      beside += !view.beside_lines.empty() && view.beside_lines[view.probe.nearest_pixel(at)];
    }
    return beside >= kFewestViews && 3 * beside >= seen;
  }

  /// The greatest distance that a silhouette (but for those that may miss it) or the box gives a
  /// point, voxels; at least `enough` stops the search for a greater one.
  double at(const dvec3& p, double enough) const {
    const dvec3 beyond = glm::max(low_ - p, p - high_);
    double value = std::max({beyond.x, beyond.y, beyond.z});
    int seen = 0, beyond_enough = 0;
    thread_local std::vector<double> said, full;
    said.clear(), full.clear();
    Appearance seen_at;
    for (const View& view : views_) {
      if (!view.probe.sees(p, seen_at)) continue;
      ++seen;
      if (!view.probe.has_outline()) continue;
      const double per_pixel = seen_at.depth * view.per_depth;
      said.push_back(view.probe.distance(seen_at) * per_pixel);
      full.push_back(full_evidence_ * per_pixel);
      beyond_enough += said.back() - full.back() >= enough;
      if (beyond_enough > missing_) return enough;
    }
    if (seen < least_views_) return double(SparseVolume::kBand);
    if (int(said.size()) <= missing_) return value;
    if (full_evidence_ > 0) return std::max(value, distance_by_evidence(said, full));
    std::nth_element(said.begin(), said.begin() + missing_, said.end(), std::greater<>());
    return std::max(value, said[std::size_t(missing_)]);
  }

 private:
  struct View {
    OutlineProbe probe;
    double per_depth;                        ///< voxels of a pixel at depth 1
    std::vector<std::uint8_t> beside_lines;  ///< a pixel each; empty where there are no lines
  };

  /// As in carving_hull_distance.comp.glsl.
  static double distance_by_evidence(std::span<const double> said, std::span<const double> full) {
    double s = -1e30;
    for (std::size_t i = 0; i < said.size(); ++i) s = std::max(s, said[i] - full[i]);
    for (double last = -1e30; s > last;) {
      last = s;
      double slopes = 0, weighted = 0;
      for (std::size_t i = 0; i < said.size(); ++i)
        if (said[i] > last) slopes += 1 / full[i], weighted += said[i] / full[i];
      s = std::max((weighted - 1) / slopes, last);
    }
    return s;
  }

  static std::vector<std::uint8_t> beside_lines(const Silhouette& silhouette) {
    std::vector<std::uint8_t> marks;
    if (!silhouette.lines || silhouette.lines->empty() || !silhouette.distance) return marks;
    const int width = silhouette.distance->width, height = silhouette.distance->height;
    marks.resize(silhouette.distance->pixels.size());
    for (const LinePoint& p : *silhouette.lines)
      for (int y = std::max(int(p.y) - kBeside, 0); y <= std::min(int(p.y) + kBeside, height - 1);
           ++y)
        for (int x = std::max(int(p.x) - kBeside, 0); x <= std::min(int(p.x) + kBeside, width - 1);
             ++x)
          marks[std::size_t(y) * std::size_t(width) + std::size_t(x)] = 1;
    return marks;
  }

  dvec3 low_, high_;
  int least_views_, missing_;
  double full_evidence_;  ///< pixels
  std::vector<View> views_;
};

/// Does the distance rise on all sides, as nowhere at the boundary of a part thicker than a voxel?
bool in_valley(const SparseVolume& volume, const ivec3& voxel, float value) {
  for (int i = 0; i < 27; ++i)
    if (volume.at(voxel + ivec3(i % 3, i / 3 % 3, i / 9) - 1) < value - kOnSlope) return false;
  return true;
}

/// The deepest point of the field within a voxel, by steps along the axes.
double deepest(const Field& field, const ivec3& voxel, double start, dvec3& where) {
  double best = start;
  dvec3 offset(0);
  for (double step = kFirstStep; step >= kLastStep;) {
    dvec3 next = offset;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        dvec3 tried = offset;
        tried[axis] = std::clamp(tried[axis] + sign * step, -0.5, 0.5);
        const double value = field.at(dvec3(voxel) + tried, best);
        if (value < best) best = value, next = tried;
      }
    if (next == offset) step /= 2;
    offset = next;
  }
  where = dvec3(voxel) + offset;
  return best;
}

/// Voxels that hold a part of the hull: those in valleys whose part the volume does not have, or
/// else those on stems.
std::vector<Joint> search(const Field& field, bool valleys, const SparseVolume& volume) {
  std::vector<std::vector<Joint>> found(volume.bricks.size());
  tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
    for (int i = 0; i < kBrickVoxels; ++i) {
      const float value = volume.distance[slot * kBrickVoxels + std::size_t(i)];
      if (value <= 0 || value >= kReach) continue;
      const ivec3 voxel = volume.bricks[slot] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7);
      if (valleys ? !in_valley(volume, voxel, value) : !field.on_stem(dvec3(voxel))) continue;
      dvec3 where;
      const double depth = deepest(field, voxel, value, where);
      // Voxels that touch at an edge alone have a surface each, whatever is between their centres.
      if (depth < 0 && (!valleys || volume.interpolated(where) > 0))
        found[slot].push_back({voxel, float(depth)});
    }
  });
  std::vector<Joint> all;
  for (const std::vector<Joint>& list : found) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace

std::size_t keep_thin_parts(SparseVolume& volume, const Box& box, std::span<const Camera> cameras,
                            std::span<const Silhouette> silhouettes, const HullOptions& options) {
  if (std::none_of(silhouettes.begin(), silhouettes.end(),
                   [](const Silhouette& s) { return s.distance; }))
    return 0;
  const Field field(volume.grid, box, cameras, silhouettes, options);
  const std::vector<Joint> found = search(field, true, volume);
  for (const Joint& joint : found) put(joint, volume);
  if (!field.has_lines()) return found.size();
  // Beside something thicker there is no valley: where a leaf hangs on its stem. Of what lies
  // there, what joins parts is taken, and no more.
  const std::vector<Joint> joints = search(field, false, volume);
  const std::vector<std::size_t> joining = find_joining(volume, joints);
  for (const std::size_t i : joining) put(joints[i], volume);
  return found.size() + joining.size();
}

std::vector<bool> on_stems(const GridSpec& grid, std::span<const Camera> cameras,
                           std::span<const Silhouette> silhouettes,
                           std::span<const glm::ivec3> voxels) {
  std::vector<bool> out(voxels.size(), false);
  const Field field(grid, grid.bounds(), cameras, silhouettes, {});
  if (!field.has_lines()) return out;
  for (std::size_t i = 0; i < voxels.size(); ++i) out[i] = field.on_stem(dvec3(voxels[i]));
  return out;
}

}  // namespace photohull::carving
