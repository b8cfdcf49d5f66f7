#include "carving/thin_parts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "projtex/gpu_views.h"

namespace photohull::carving {
namespace {

using glm::dvec3;
using glm::ivec3;

constexpr float kReach = 0.87f;   // voxels from a voxel's centre to its corners
constexpr float kOnSlope = 0.5f;  // drop to a neighbour that the boundary of a thick part has
constexpr double kFirstStep = 0.25, kLastStep = 0.05;  // of the search within a voxel

/// The silhouettes in the lattice's frame.
class Field {
 public:
  Field(const GridSpec& grid, const Box& box, std::span<const Camera> cameras,
        std::span<const Silhouette> silhouettes, const HullOptions& options)
      : low_((box.min - grid.origin) / grid.voxel_size),
        high_((box.max - grid.origin) / grid.voxel_size),
        least_views_(options.min_views) {
    for (std::size_t v = 0; v < cameras.size(); ++v)
      views_.push_back({projtex::to_grid(cameras[v], grid), silhouettes[v].distance});
  }

  /// The greatest distance that a silhouette or the box gives a point, voxels; at least `enough`
  /// stops the search for a greater one.
  double at(const dvec3& p, double enough) const {
    const dvec3 beyond = glm::max(low_ - p, p - high_);
    double value = std::max({beyond.x, beyond.y, beyond.z});
    int seen = 0;
    for (const View& view : views_) {
      const dvec3 q = view.camera.projection * glm::dvec4(p, 1);
      if (q.z <= 0) continue;
      const double x = q.x / q.z, y = q.y / q.z;
      if (x < -0.5 || y < -0.5 || x > view.camera.width - 0.5 || y > view.camera.height - 0.5)
        continue;
      ++seen;
      if (view.distance)
        value = std::max(value, bilinear(*view.distance, x, y) * q.z / view.camera.focal);
      if (value >= enough) return value;
    }
    return seen < least_views_ ? double(SparseVolume::kBand) : value;
  }

 private:
  struct View {
    projtex::GridCamera camera;
    const SilhouetteDistance* distance;
  };

  static double bilinear(const SilhouetteDistance& d, double x, double y) {
    const int left = int(std::floor(x)), top = int(std::floor(y));
    const auto pixel = [&](int i, int j) {
      return double(d.pixels[std::size_t(std::clamp(j, 0, d.height - 1)) * std::size_t(d.width) +
                             std::size_t(std::clamp(i, 0, d.width - 1))]);
    };
    const double u = x - left, v = y - top;
    return (1 - v) * ((1 - u) * pixel(left, top) + u * pixel(left + 1, top)) +
           v * ((1 - u) * pixel(left, top + 1) + u * pixel(left + 1, top + 1));
  }

  dvec3 low_, high_;
  int least_views_;
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

}  // namespace

std::size_t keep_thin_parts(SparseVolume& volume, const Box& box, std::span<const Camera> cameras,
                            std::span<const Silhouette> silhouettes, const HullOptions& options) {
  if (std::none_of(silhouettes.begin(), silhouettes.end(),
                   [](const Silhouette& s) { return s.distance; }))
    return 0;
  const Field field(volume.grid, box, cameras, silhouettes, options);
  struct Change {
    std::size_t index;
    float distance;
  };
  std::vector<std::vector<Change>> changes(volume.bricks.size());
  tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
    for (int i = 0; i < kBrickVoxels; ++i) {
      const std::size_t index = slot * kBrickVoxels + std::size_t(i);
      const float value = volume.distance[index];
      if (value <= 0 || value >= kReach) continue;
      const ivec3 voxel = volume.bricks[slot] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7);
      if (!in_valley(volume, voxel, value)) continue;
      dvec3 where;
      const double depth = deepest(field, voxel, value, where);
      if (depth < 0 && volume.interpolated(where) > 0)
        changes[slot].push_back({index, float(depth)});
    }
  });
  std::size_t changed = 0;
  for (const std::vector<Change>& list : changes) {
    changed += list.size();
    for (const Change& change : list) volume.distance[change.index] = change.distance;
  }
  return changed;
}

}  // namespace photohull::carving
