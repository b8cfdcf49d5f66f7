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

/// Of a grid's bricks those whose z is from `first` up to `end`.
struct Slab {
  int first = 0, end = 0;
};

/// Points of a mesh: its vertices, and points on the triangles that are larger than the spacing.
/// They come by slabs, so that memory is that of one slab's.
class MeshPoints {
 public:
  MeshPoints(const TriMesh& mesh, const GridSpec& grid, float spacing, float reach,
             std::size_t at_once)
      : mesh_(mesh),
        spacing_(spacing),
        offset_((mesh.origin - grid.origin) / grid.voxel_size),
        scale_(1.0 / grid.voxel_size) {
    cut(grid, reach, at_once);
  }

  const std::vector<Slab>& slabs() const { return slabs_; }

  /// Those that reach into a slab, and others, in the same order for every slab: add(triangle, u,
  /// v) is told of each that is on a triangle, with the weights of the second and third corner, and
  /// add_vertex(index) of each vertex.
  template <typename AddVertex, typename Add>
  std::vector<Point> of(std::size_t slab, AddVertex&& add_vertex, Add&& add) const {
    std::vector<Point> points;
    for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i) {
      if (!reaches(i, slab)) continue;
      points.push_back(vertex(i));
      add_vertex(i);
    }
    for (const auto& t : mesh_.triangles)
      if (reaches(t, slab)) add_between(t, points, add);
    return points;
  }

 private:
  static constexpr std::size_t kMostSlabs = 255;

  struct Range {
    std::uint8_t first = 0, last = 0;  // slabs; none where the last is before the first
  };

  Point vertex(std::uint32_t i) const {
    return {vec3(scale_ * glm::dvec3(mesh_.positions[i]) + offset_), mesh_.normals[i]};
  }

  bool reaches(std::uint32_t i, std::size_t slab) const {
    return ranges_.empty() || (ranges_[i].first <= slab && slab <= ranges_[i].last);
  }

  bool reaches(const std::array<std::uint32_t, 3>& t, std::size_t slab) const {
    if (ranges_.empty()) return true;
    const Range &a = ranges_[t[0]], &b = ranges_[t[1]], &c = ranges_[t[2]];
    return std::min({a.first, b.first, c.first}) <= slab &&
           slab <= std::max({a.last, b.last, c.last});
  }

  void add_between(const std::array<std::uint32_t, 3>& t, std::vector<Point>& points,
                   auto& add) const {
    const Point a = vertex(t[0]), b = vertex(t[1]), c = vertex(t[2]);
    const vec3 ab = b.position - a.position, ac = c.position - a.position, bc = ac - ab;
    const float longest =
        std::sqrt(std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)}));
    if (!(longest > spacing_)) return;
    const int steps = int(std::min(std::ceil(longest / spacing_), float(kMaxSteps)));
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

  /// Slabs of about as many vertices each.
  void cut(const GridSpec& grid, float reach, std::size_t at_once) {
    const int layers = grid.bricks.z;
    const std::size_t wanted =
        std::min((mesh_.positions.size() + at_once - 1) / at_once, kMostSlabs);
    if (wanted <= 1) {
      slabs_.push_back({0, layers});
      return;
    }
    const auto layer_at = [&](double z) {  // the first of what is no number
      return z > 0 ? int(std::min(std::floor(z / kBrickEdge), double(layers - 1))) : 0;
    };
    const auto height = [&](std::uint32_t i) { return double(vertex(i).position.z); };
    std::vector<std::size_t> counts(std::size_t(layers), 0);
    for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i)
      ++counts[std::size_t(layer_at(height(i)))];
    std::vector<std::uint8_t> slab_of(std::size_t(layers), 0);
    std::size_t passed = 0;
    for (int layer = 0; layer < layers; ++layer) {
      if (slabs_.empty() ||
          (passed >= slabs_.size() * (mesh_.positions.size() / wanted) && slabs_.size() < wanted))
        slabs_.push_back({layer, layer});
      slabs_.back().end = layer + 1;
      slab_of[std::size_t(layer)] = std::uint8_t(slabs_.size() - 1);
      passed += counts[std::size_t(layer)];
    }
    ranges_.resize(mesh_.positions.size());
    for (std::uint32_t i = 0; i < ranges_.size(); ++i)
      ranges_[i] = {slab_of[std::size_t(layer_at(height(i) - reach - 1))],
                    slab_of[std::size_t(layer_at(height(i) + reach + 1))]};
  }

  const TriMesh& mesh_;
  float spacing_;
  glm::dvec3 offset_;
  double scale_;
  std::vector<Slab> slabs_;
  std::vector<Range> ranges_;  // of the vertices; empty: there is one slab
};

class Field {
 public:
  Field(const std::vector<Point>& points, const GridSpec& grid, const Slab& slab, float reach)
      : points_(points), grid_(grid), slab_(slab), reach_(reach) {
    sort_points();
  }

  /// The slab's bricks that points reach, in the order of SparseVolume::table.
  const std::vector<ivec3>& bricks() const { return bricks_; }

  /// Their distances; the sides where planes do not tell are those of `sides`.
  std::vector<float> distances(const SparseVolume& sides) const {
    std::vector<float> out(bricks_.size() * kBrickVoxels);
    tbb::parallel_for(std::size_t(0), bricks_.size(),
                      [&](std::size_t b) { evaluate(b, sides, out.data() + b * kBrickVoxels); });
    return out;
  }

  /// Lowers the distances of `volume` by the displacement of the points near each voxel.
  void subtract(std::span<const float> displacement, SparseVolume& volume) const {
    tbb::parallel_for(std::size_t(0), bricks_.size(), [&](std::size_t brick) {
      const std::uint32_t slot = volume.table[volume.grid.brick_index(bricks_[brick])];
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
    const ivec3 last = grid_.voxels() - 1;
    const vec3 low = p.position - reach_, high = p.position + reach_;
    if (!glm::all(glm::lessThan(glm::abs(p.position), vec3(1e6f)))) return;
    const ivec3 first = glm::max(ivec3(glm::ceil(low)), 0),
                end = glm::min(ivec3(glm::floor(high)), last);
    if (glm::any(glm::greaterThan(first, end))) return;
    const ivec3 from = first / kBrickEdge, to = end / kBrickEdge;
    for (int z = std::max(from.z, slab_.first); z <= std::min(to.z, slab_.end - 1); ++z)
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) f(place(ivec3(x, y, z)));
  }

  /// Of a brick among the slab's.
  std::size_t place(const ivec3& brick) const {
    return grid_.brick_index(brick - ivec3(0, 0, slab_.first));
  }

  /// Lists for each brick the points that reach into it.
  void sort_points() {
    const ivec3 n = grid_.bricks;
    std::vector<std::uint32_t> counts(place({0, 0, slab_.end}), 0), next;
    for (const Point& p : points_) for_bricks_near(p, [&](std::size_t brick) { ++counts[brick]; });
    first_.push_back(0);
    std::size_t index = 0;
    for (int z = slab_.first; z < slab_.end; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x, ++index) {
          if (!counts[index]) continue;
          bricks_.emplace_back(x, y, z);
          first_.push_back(first_.back() + counts[index]);
          counts[index] = std::uint32_t(next.size());  // from here on where its list is
          next.push_back(first_[next.size()]);
        }
    listed_.resize(first_.back());
    for (std::size_t i = 0; i < points_.size(); ++i)
      for_bricks_near(points_[i], [&](std::size_t brick) {
        listed_[next[counts[brick]]++] = std::uint32_t(i);
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
    const ivec3 corner = bricks_[brick] * kBrickEdge;
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

  void evaluate(std::size_t brick, const SparseVolume& sides, float* out) const {
    Blend b;
    blend(
        brick, [](std::uint32_t, const Floats& plane) { return plane; }, b);
    const float ratio = float(grid_.voxel_size / sides.grid.voxel_size);
    const vec3 offset((grid_.origin - sides.grid.origin) / sides.grid.voxel_size);
    for (int v = 0; v < kBrickVoxels; ++v) {
      const ivec3 voxel = bricks_[brick] * kBrickEdge + ivec3(v >> 6, (v >> 3) & 7, v & 7);
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
  const GridSpec& grid_;
  Slab slab_;
  float reach_;
  std::vector<ivec3> bricks_;
  std::vector<std::uint32_t> first_, listed_;
};

/// One after the other; each part goes when it has been taken.
std::vector<float> joined(std::vector<std::vector<float>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  std::size_t size = 0;
  for (const auto& part : parts) size += part.size();
  std::vector<float> out;
  out.reserve(size);
  for (auto& part : parts) {
    out.insert(out.end(), part.begin(), part.end());
    std::vector<float>().swap(part);
  }
  return out;
}

/// Bricks that are not stored lie on the side that `sides` says.
void fill_table(const SparseVolume& sides, SparseVolume& out) {
  std::size_t index = 0;
  for (int z = 0; z < out.grid.bricks.z; ++z)
    for (int y = 0; y < out.grid.bricks.y; ++y)
      for (int x = 0; x < out.grid.bricks.x; ++x) {
        std::uint32_t& entry = out.table[index++];
        if (entry != SparseVolume::kOutside) continue;
        const glm::dvec3 middle =
            out.grid.world(glm::dvec3(ivec3(x, y, z) * kBrickEdge) + 0.5 * (kBrickEdge - 1));
        const glm::dvec3 at = (middle - sides.grid.origin) / sides.grid.voxel_size;
        if (sides.at(ivec3(glm::floor(at + 0.5))) < 0) entry = SparseVolume::kInside;
      }
}

}  // namespace

void move_surface(SparseVolume& volume, const TriMesh& mesh, std::span<const float> displacement,
                  std::size_t at_once) {
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(displacement.size(), ==, mesh.positions.size());
  const MeshPoints mesh_points(mesh, volume.grid, kMoveSpacing, SparseVolume::kBand, at_once);
  for (std::size_t slab = 0; slab < mesh_points.slabs().size(); ++slab) {
    std::vector<float> moves;
    const auto points = mesh_points.of(
        slab, [&](std::uint32_t i) { moves.push_back(displacement[i]); },
        [&](const auto& t, float u, float v) {
          moves.push_back((1 - u - v) * displacement[t[0]] + u * displacement[t[1]] +
                          v * displacement[t[2]]);
        });
    Field(points, volume.grid, mesh_points.slabs()[slab], SparseVolume::kBand)
        .subtract(moves, volume);
  }
}

SparseVolume distance_from_mesh(const TriMesh& mesh, const SparseVolume& sides,
                                const GridSpec& grid, double reach, std::size_t at_once) {
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(sides.grid.voxel_size, >, 0.0);
  SparseVolume out;
  out.grid = grid;
  out.table.assign(grid.brick_count(), SparseVolume::kOutside);
  const MeshPoints mesh_points(mesh, grid, kSpacing, float(reach), at_once);
  std::vector<std::vector<float>> parts;
  for (std::size_t slab = 0; slab < mesh_points.slabs().size(); ++slab) {
    const auto points = mesh_points.of(
        slab, [](std::uint32_t) {}, [](const auto&...) {});
    const Field field(points, grid, mesh_points.slabs()[slab], float(reach));
    parts.push_back(field.distances(sides));
    for (const ivec3& brick : field.bricks()) {
      out.table[grid.brick_index(brick)] = std::uint32_t(out.bricks.size());
      out.bricks.push_back(brick);
    }
  }
  out.distance = joined(std::move(parts));
  fill_table(sides, out);
  return out;
}

}  // namespace photohull
