// Signed distance from tangent planes [Hoppe92], blended with the weights of moving least squares.
#include "volume/distance_from_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/error.h"

namespace photohull {
namespace {

using glm::ivec3;
using glm::vec3;

constexpr float kSpacing = 1.25f;     // voxels between points on a triangle, at most
constexpr float kMoveSpacing = 2.5f;  // the same for displacements, which vary less
constexpr int kMaxSteps = 256;        // along a triangle's edge: one of nonsense must not stall
constexpr float kBlend = 0.6f;        // voxels: width of the blend between tangent planes
constexpr float kSameWay = 0.3f;      // cosine between normals that are blended
constexpr float kDoubt = 1;  // voxels of the old volume within which its sides are not trusted
constexpr float kUnknown = std::numeric_limits<float>::infinity();

/// Voxels in a row along z, which is how bricks store them, and what vector instructions take.
constexpr int kRun = 4, kRuns = kBrickVoxels / kRun;
using Floats [[gnu::vector_size(16)]] = float;
constexpr Floats kSteps = {0, 1, 2, 3};

struct Point {
  vec3 position, normal;  // voxel coordinates
};

std::vector<Point> vertices_of(const TriMesh& mesh, const GridSpec& grid) {
  const glm::dvec3 offset = (mesh.origin - grid.origin) / grid.voxel_size;
  const double scale = 1.0 / grid.voxel_size;
  std::vector<Point> points(mesh.positions.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {vec3(scale * glm::dvec3(mesh.positions[i]) + offset), mesh.normals[i]};
  return points;
}

/// Vertices, and points on the triangles that are larger than the spacing: add(triangle, u, v) is
/// told of each of these, with the weights of the second and third corner.
template <typename Add>
std::vector<Point> points_of(const TriMesh& mesh, const GridSpec& grid, float spacing, Add&& add) {
  std::vector<Point> points = vertices_of(mesh, grid);
  for (const auto& t : mesh.triangles) {
    const Point a = points[t[0]], b = points[t[1]], c = points[t[2]];
    const vec3 ab = b.position - a.position, ac = c.position - a.position, bc = ac - ab;
    const float longest =
        std::sqrt(std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)}));
    if (!(longest > spacing)) continue;
    const int steps = int(std::min(std::ceil(longest / spacing), float(kMaxSteps)));
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        if ((i == 0 && j == 0) || i == steps || j == steps) continue;
        const float u = float(i) / float(steps), v = float(j) / float(steps);
        const vec3 normal = (1 - u - v) * a.normal + u * b.normal + v * c.normal;
        const float length = glm::length(normal);
        if (!(length > 0.1f)) continue;
        points.push_back({a.position + u * ab + v * ac, normal / length});
        add(t, u, v);
      }
  }
  return points;
}

class Field {
 public:
  Field(const std::vector<Point>& points, const GridSpec& grid, float reach)
      : points_(points), reach_(reach) {
    out_.grid = grid;
    out_.table.assign(grid.brick_count(), SparseVolume::kOutside);
    sort_points();
  }

  /// Distances; the sides where planes do not tell are those of `sides`.
  SparseVolume run(const SparseVolume& sides) {
    out_.distance.resize(out_.bricks.size() * kBrickVoxels);
    tbb::parallel_for(std::size_t(0), out_.bricks.size(),
                      [&](std::size_t b) { evaluate(b, sides); });
    std::size_t index = 0;
    for (int z = 0; z < out_.grid.bricks.z; ++z)
      for (int y = 0; y < out_.grid.bricks.y; ++y)
        for (int x = 0; x < out_.grid.bricks.x; ++x) {
          std::uint32_t& entry = out_.table[index++];
          if (entry != SparseVolume::kOutside) continue;
          const glm::dvec3 middle =
              out_.grid.world(glm::dvec3(ivec3(x, y, z) * kBrickEdge) + 0.5 * (kBrickEdge - 1));
          const glm::dvec3 at = (middle - sides.grid.origin) / sides.grid.voxel_size;
          if (sides.at(ivec3(glm::floor(at + 0.5))) < 0) entry = SparseVolume::kInside;
        }
    return std::move(out_);
  }

  /// Lowers the distances of `volume` by the displacement of the points near each voxel.
  void subtract(std::span<const float> displacement, SparseVolume& volume) const {
    tbb::parallel_for(std::size_t(0), out_.bricks.size(), [&](std::size_t brick) {
      const std::uint32_t slot = volume.table[volume.grid.brick_index(out_.bricks[brick])];
      if (slot >= SparseVolume::kInside) return;
      Blend b;
      blend(
          brick, [&](std::uint32_t i, const Floats&) { return displacement[i]; }, b);
      float* values = volume.distance.data() + std::size_t(slot) * kBrickVoxels;
      for (int v = 0; v < kBrickVoxels; ++v) {
        const float sum = b.sum[v / kRun][v % kRun], total = b.total[v / kRun][v % kRun];
        if (total > 0)
          values[v] =
              std::clamp(values[v] - sum / total, -SparseVolume::kBand, SparseVolume::kBand);
      }
    });
  }

 private:
  template <typename F>
  void for_bricks_near(const Point& p, F&& f) const {
    const ivec3 last = out_.grid.voxels() - 1;
    const vec3 low = p.position - reach_, high = p.position + reach_;
    if (!glm::all(glm::lessThan(glm::abs(p.position), vec3(1e6f)))) return;
    const ivec3 first = glm::max(ivec3(glm::ceil(low)), 0),
                end = glm::min(ivec3(glm::floor(high)), last);
    if (glm::any(glm::greaterThan(first, end))) return;
    const ivec3 from = first / kBrickEdge, to = end / kBrickEdge;
    for (int z = from.z; z <= to.z; ++z)
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) f(ivec3(x, y, z));
  }

  /// Lists for each brick the points that reach into it.
  void sort_points() {
    std::vector<std::uint32_t> counts(out_.table.size(), 0);
    for (const Point& p : points_)
      for_bricks_near(p, [&](const ivec3& b) { ++counts[out_.grid.brick_index(b)]; });
    first_.push_back(0);
    std::size_t index = 0;
    const ivec3 n = out_.grid.bricks;
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x, ++index) {
          if (!counts[index]) continue;
          out_.table[index] = std::uint32_t(out_.bricks.size());
          out_.bricks.emplace_back(x, y, z);
          first_.push_back(first_.back() + counts[index]);
        }
    listed_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < points_.size(); ++i)
      for_bricks_near(points_[i], [&](const ivec3& b) {
        listed_[next[out_.table[out_.grid.brick_index(b)]]++] = std::uint32_t(i);
      });
  }

  /// Calls f(run, squared distances, signed distances to the tangent plane) for the runs of voxels
  /// that the point may reach.
  template <typename F>
  void for_runs(const Point& p, const ivec3& corner, F&& f) const {
    const vec3 local = p.position - vec3(corner);
    const ivec3 low = glm::max(ivec3(glm::ceil(local - reach_)), 0);
    const ivec3 high = glm::min(ivec3(glm::floor(local + reach_)), kBrickEdge - 1);
    const float square = reach_ * reach_;
    for (int x = low.x; x <= high.x; ++x)
      for (int y = low.y; y <= high.y; ++y) {
        const float dx = float(x) - local.x, dy = float(y) - local.y, line = dx * dx + dy * dy;
        if (line > square) continue;
        const float plane = dx * p.normal.x + dy * p.normal.y;
        for (int run = low.z / kRun; run <= high.z / kRun; ++run) {
          const Floats dz = kSteps + (float(kRun * run) - local.z);
          f(((x << 6) | (y << 3)) / kRun + run, line + dz * dz, plane + dz * p.normal.z);
        }
      }
  }

  struct Blend {
    std::array<Floats, kRuns> nearest, sum{}, total{};  // squared distance; weighted values
  };

  /// Blends value(point, signed distances to its plane) at the voxels of a brick: the nearest point
  /// decides, others that look the same way join in by how much farther they are.
  template <typename F>
  void blend(std::size_t brick, F&& value, Blend& out) const {
    std::array<Floats, kRuns> nx{}, ny{}, nz{};  // normals of the nearest points
    out.nearest.fill(Floats{} + kUnknown);
    const ivec3 corner = out_.bricks[brick] * kBrickEdge;
    const float square = reach_ * reach_;
    const auto points =
        std::span(listed_).subspan(first_[brick], first_[brick + 1] - first_[brick]);
    for (const std::uint32_t i : points) {
      const vec3 n = points_[i].normal;
      for_runs(points_[i], corner, [&](int run, const Floats& d2, const Floats&) {
        const auto closer = (d2 <= square) & (d2 < out.nearest[run]);
        out.nearest[run] = closer ? d2 : out.nearest[run];
        nx[run] = closer ? Floats{} + n.x : nx[run];
        ny[run] = closer ? Floats{} + n.y : ny[run];
        nz[run] = closer ? Floats{} + n.z : nz[run];
      });
    }
    constexpr float kScale = -1 / (kBlend * kBlend);
    for (const std::uint32_t i : points) {
      const vec3 n = points_[i].normal;
      for_runs(points_[i], corner, [&](int run, const Floats& d2, const Floats& plane) {
        const Floats same = n.x * nx[run] + n.y * ny[run] + n.z * nz[run];
        // exp((d2 - nearest) scale), cheaply; 0 from -8 on.
        Floats w = 1 + (d2 - out.nearest[run]) * (kScale / 8);
        w = ((d2 <= square) & (same >= kSameWay) & (w > 0)) ? w : Floats{};
        w *= w, w *= w, w *= w;
        out.sum[run] += w * value(i, plane);
        out.total[run] += w;
      });
    }
  }

  void evaluate(std::size_t brick, const SparseVolume& sides) {
    Blend b;
    blend(
        brick, [](std::uint32_t, const Floats& plane) { return plane; }, b);
    float* out = out_.distance.data() + brick * kBrickVoxels;
    const float ratio = float(out_.grid.voxel_size / sides.grid.voxel_size);
    const vec3 offset((out_.grid.origin - sides.grid.origin) / sides.grid.voxel_size);
    for (int v = 0; v < kBrickVoxels; ++v) {
      const ivec3 voxel = out_.bricks[brick] * kBrickEdge + ivec3(v >> 6, (v >> 3) & 7, v & 7);
      const float side = sides.at(ivec3(glm::floor(ratio * vec3(voxel) + offset + 0.5f)));
      const int run = v / kRun, k = v % kRun;
      const float limit = std::min(std::sqrt(b.nearest[run][k]), SparseVolume::kBand);
      const bool known = b.total[run][k] > 0;
      const float plane = known ? std::clamp(b.sum[run][k] / b.total[run][k], -limit, limit) : 0;
      out[v] = known && (std::abs(side) < kDoubt || plane * side > 0) ? plane
                                                                      : std::copysign(limit, side);
    }
  }

  const std::vector<Point>& points_;
  float reach_;
  SparseVolume out_;
  std::vector<std::uint32_t> first_, listed_;
};

}  // namespace

void move_surface(SparseVolume& volume, const TriMesh& mesh, std::span<const float> displacement) {
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(displacement.size(), ==, mesh.positions.size());
  std::vector<float> all(displacement.begin(), displacement.end());
  const auto points =
      points_of(mesh, volume.grid, kMoveSpacing, [&](const auto& t, float u, float v) {
        all.push_back((1 - u - v) * all[t[0]] + u * all[t[1]] + v * all[t[2]]);
      });
  Field(points, volume.grid, SparseVolume::kBand).subtract(all, volume);
}

SparseVolume distance_from_mesh(const TriMesh& mesh, const SparseVolume& sides,
                                const GridSpec& grid, double reach) {
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(sides.grid.voxel_size, >, 0.0);
  const auto points = points_of(mesh, grid, kSpacing, [](const auto&...) {});
  return Field(points, grid, float(reach)).run(sides);
}

}  // namespace photohull
