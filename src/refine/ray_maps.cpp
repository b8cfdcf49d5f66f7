#include "refine/ray_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "core/viewing_depth.h"
#include "refine/ray_partners.h"
#include "refine/ray_search.h"
#include "refine/ray_tasks.h"

namespace photohull::refine {
namespace {

// Samples about the surface that say whether it explains what a ray shows, voxels apart.
constexpr int kSurfaceSamples = 2;
constexpr double kBeside = 2;         // voxels from the surface within which a ray says nothing new
constexpr double kLeastStride = 1.5;  // pixels between rays: closer ones show the same
// Share of the variance of what a ray shows that noise does not explain, below which it does not
// search space that no surface bounds: plain background fits anywhere.
constexpr float kLeastTexture = 0.5f;

/// At the voxel nearest to a point that is not far below 0.
double value_at(const SparseVolume& v, const glm::dvec3& p) { return v.at(glm::ivec3(p + 0.5)); }

constexpr double kAcross =
    0.8;                        // of the distance to the hull's surface, that a step along a ray is
constexpr int kMostClear = 16;  // bricks
constexpr int kSeeds = 1024;    // of rays of parts; a power of two

/// How far empty space reaches about each brick of a hull: that many bricks to every side, at most
/// kMostClear, are outside; 0 where the brick is not.
std::vector<std::uint8_t> clear_space(const SparseVolume& hull) {
  const glm::ivec3 n = hull.grid.bricks;
  std::vector<std::uint8_t> clear(hull.table.size());
  for (std::size_t i = 0; i < clear.size(); ++i)
    clear[i] = hull.table[i] == SparseVolume::kOutside ? kMostClear : 0;
  // Chessboard distances, axis by axis: the least over what lies k bricks away, but at least k.
  std::array<std::size_t, 3> strides{1, std::size_t(n.x), std::size_t(n.x) * std::size_t(n.y)};
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t stride = strides[std::size_t(axis)];
    std::vector<std::uint8_t> line(static_cast<std::size_t>(n[axis]));
    for (std::size_t first = 0; first < clear.size(); ++first) {
      if (first / stride % line.size() != 0) continue;  // not where a line begins
      for (std::size_t i = 0; i < line.size(); ++i) line[i] = clear[first + i * stride];
      for (std::size_t i = 0; i < line.size(); ++i) {
        std::uint8_t least = line[i];
        for (std::size_t k = 1; k < least; ++k) {
          const auto at = [&](std::size_t j) { return std::max(line[j], std::uint8_t(k)); };
          if (i >= k) least = std::min(least, at(i - k));
          if (i + k < line.size()) least = std::min(least, at(i + k));
        }
        clear[first + i * stride] = least;
      }
    }
  }
  return clear;
}

/// Where a ray enters the surface, about `t` voxels along it.
double crossing(const SparseVolume& surface, const glm::dvec3& from, const glm::dvec3& direction,
                double t) {
  double outside = t - 1.5, inside = t + 1;
  if (surface.interpolated(from + inside * direction) > 0) return t;
  for (int i = 0; i < 6; ++i) {
    const double middle = 0.5 * (outside + inside);
    (surface.interpolated(from + middle * direction) > 0 ? outside : inside) = middle;
  }
  return 0.5 * (outside + inside);
}

/// The surface's normal at a place on it; that of a plane across the ray where it has none.
glm::dvec3 normal_at(const SparseVolume& surface, const Ray& ray) {
  const glm::dvec3 p = ray.from + ray.surface * ray.direction;
  glm::dvec3 slope;
  for (int a = 0; a < 3; ++a) {
    glm::dvec3 e(0);
    e[a] = 1;
    slope[a] = surface.interpolated(p + e) - surface.interpolated(p - e);
  }
  return glm::dot(slope, ray.direction) < 0 ? glm::normalize(slope) : -ray.direction;
}

/// In voxels, one more than GridSpec::frame().
Box frame_of(const GridSpec& grid) {
  const Box frame = grid.frame();
  return {frame.min, frame.max + 1.0};
}

class RayMapper {
 public:
  RayMapper(gpu::Context& context, const SparseVolume& hull, const SparseVolume* surface,
            const projtex::Photographs& photographs, const VoteOptions& options)
      : hull_(hull),
        surface_(surface),
        options_(options),
        clear_(clear_space(hull)),
        sources_(photographs.cameras),
        in_parts_(photographs.are_of_part()),
        cameras_(projtex::to_grid(photographs.cameras, hull.grid)),
        partners_(
            choose_partners(cameras_, frame_of(hull.grid), options.nearest_partner, options.tiles)),
        search_(context, photographs.images, cameras_, photographs.noise_sigma, options) {}

  RayMap map_of(std::size_t v) const {
    RayMap map = empty_map(v);
    std::vector<Ray> rays = make_rays(v, map);
    std::vector<Finding> findings(rays.size());
    if (surface_) explain(v, rays, findings, map);
    search_.sweep(rays, partners_[v], findings);
    search_.spread(rays, map.width, map.height, partners_[v], findings);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!findings[i].known && findings[i].score >= options_.least_score)
        tell(v, rays[i], findings[i].along,
             confidence(findings[i].score) *
                 std::clamp(findings[i].lead() / options_.distinct_by, 0.0, 1.0),
             map);
    return map;
  }

 private:
  RayMap empty_map(std::size_t v) const {
    const auto& c = cameras_[v];
    const double depth =
        viewing_depth(c.projection, c.centre, c.width, c.height, frame_of(hull_.grid));
    RayMap map;
    map.stride = std::max(kLeastStride, options_.ray_spacing * c.focal / std::max(depth, 1.0));
    if (in_parts_) {
      // An even number of rays lies before the principal point, wherever the photograph was cut:
      // which neighbours a ray looks at depends on whether its place is even.
      const glm::dvec2 place = principal_place(v, map);
      map.shift = 2.0 * glm::ceil(0.5 * place) - place;
    }
    map.width = int(std::ceil(c.width / map.stride + map.shift.x));
    map.height = int(std::ceil(c.height / map.stride + map.shift.y));
    map.depth.assign(std::size_t(map.width) * map.height, 0);
    map.weight = map.depth;
    return map;
  }

  /// Of the principal point, in strides from the image's edges.
  glm::dvec2 principal_place(std::size_t v, const RayMap& map) const {
    const Intrinsics& k = sources_[v].intrinsics;
    return (glm::dvec2(k.cx, k.cy) + 0.5) / map.stride;
  }

  /// What a ray of a part goes by in place of its number: the same in all parts.
  int seed_of(const glm::ivec2& from_principal) const {
    return (31 * from_principal.x + 17 * from_principal.y) & (kSeeds - 1);
  }

  /// Calls visit(t) for places in the hull along a ray, from `t` voxels on, until it returns false.
  template <typename Visit>
  void walk(const glm::dvec3& from, const glm::dvec3& d, double t, Visit&& visit) const {
    const glm::dvec3 high(hull_.grid.voxels() - 1);
    double end = 1e9;
    for (int a = 0; a < 3; ++a) {
      if (std::abs(d[a]) < 1e-12) continue;
      const double s = (0 - from[a]) / d[a], e = (high[a] - from[a]) / d[a];
      t = std::max(t, std::min(s, e));
      end = std::min(end, std::max(s, e));
    }
    const glm::dvec3 inverse = 1.0 / d;
    while (t < end) {
      const glm::dvec3 at = from + t * d + 0.5;
      const glm::ivec3 brick = glm::ivec3(at) / kBrickEdge;
      if (const int clear = clear_at(brick); clear > 0) {
        // The same steps as below, as far as the space about the brick is sure to be outside.
        double left = end;
        for (int a = 0; a < 3; ++a) {
          if (std::abs(d[a]) < 1e-12) continue;
          const int side = d[a] > 0 ? brick[a] + clear : brick[a] - clear + 1;
          left = std::min(left, t + (side * kBrickEdge - at[a]) * inverse[a]);
        }
        constexpr double kStep = SparseVolume::kBand * kAcross;
        t += std::max(1.0, std::ceil((left - t) / kStep)) * kStep;
        continue;
      }
      const double value = value_at(hull_, from + t * d);
      if (value <= 0.3 && !visit(t)) return;
      t += std::max(0.5, std::abs(value) * kAcross);
    }
  }

  /// clear_space of a brick; 0 beside the grid.
  int clear_at(const glm::ivec3& brick) const {
    const glm::ivec3 n = hull_.grid.bricks;
    const bool on_grid = unsigned(brick.x) < unsigned(n.x) && unsigned(brick.y) < unsigned(n.y) &&
                         unsigned(brick.z) < unsigned(n.z);
    return on_grid ? clear_[hull_.grid.brick_index(brick)] : 0;
  }

  /// A ray that ended where it met the surface goes on to where it leaves the hull.
  void reach_through_hull(Ray& ray) const {
    double last = ray.length - 1;
    walk(ray.from, ray.direction, last, [&](double t) {
      last = t;
      return true;
    });
    ray.length = last + 1;
  }

  /// Rays through the hull, and with a surface only as far as that.
  std::vector<Ray> make_rays(std::size_t v, const RayMap& map) const {
    const auto& c = cameras_[v];
    const glm::dmat3 m(c.projection[0], c.projection[1], c.projection[2]);
    const glm::dmat3 inverse = glm::inverse(m);
    const glm::ivec2 middle(glm::round(principal_place(v, map) + map.shift));
    std::vector<std::vector<Ray>> rows(std::size_t(map.height));
    tbb::parallel_for(0, map.height, [&](int y) {
      for (int x = 0; x < map.width; ++x) {
        const glm::dvec2 pixel = map.pixel(x, y);
        if (in_parts_ && !sources_[v].on_image(pixel)) continue;
        const glm::dvec3 d = glm::normalize(inverse * glm::dvec3(pixel, 1));
        double first = -1, last = -1, at = -1;
        walk(c.centre, d, 0, [&](double t) {
          if (first < 0) first = t;
          last = t;
          if (!surface_ || value_at(*surface_, c.centre + t * d) > 0) return true;
          at = crossing(*surface_, c.centre, d, t);
          return false;
        });
        if (first < 0) continue;
        first -= 1;
        last += 1;
        int seed = -1;
        if (in_parts_) {
          first = std::floor(first), last = std::ceil(last);  // wherever the part's grid begins
          seed = seed_of(glm::ivec2(x, y) - middle);
        }
        rows[std::size_t(y)].push_back({x, y, c.centre + first * d, d, last - first, (m * d).z,
                                        at < 0 ? -1 : at - first,
                                        partners_[v].tile(x, y, map.width, map.height), seed});
      }
    });
    std::vector<Ray> rays;
    for (const auto& row : rows) rays.insert(rays.end(), row.begin(), row.end());
    return rays;
  }

  /// What the surface explains is known, and its planes spread to rays beside. Of rays that
  /// meet no surface those stay that bare_reach allows and that show more than plain background.
  void explain(std::size_t v, std::vector<Ray>& rays, std::vector<Finding>& findings,
               RayMap& map) const {
    std::vector<Ray> meeting, missing;
    for (const Ray& ray : rays) (ray.surface < 0 ? missing : meeting).push_back(ray);
    std::vector<Ray> about = meeting;
    for (Ray& ray : about) {
      ray.from += (ray.surface - 0.5 * (kSurfaceSamples - 1)) * ray.direction;
      ray.length = kSurfaceSamples;
    }
    findings.assign(meeting.size(), {});
    search_.scores_along(about, partners_[v], kSurfaceSamples, [&](std::size_t i, const float* s) {
      findings[i].score = *std::max_element(s, s + kSurfaceSamples);
      findings[i].known = findings[i].score >= options_.least_score;
    });
    tbb::parallel_for(std::size_t(0), meeting.size(), [&](std::size_t i) {
      Finding& found = findings[i];
      if (found.known) {
        found.along = meeting[i].surface;
        found.normal = normal_at(*surface_, meeting[i]);
      } else {
        found = {};
        reach_through_hull(meeting[i]);
      }
    });
    for (std::size_t i = 0; i < meeting.size(); ++i)
      if (findings[i].known)
        tell(v, meeting[i], meeting[i].surface, confidence(findings[i].score), map);
    rays = std::move(meeting);
    if (options_.bare_reach == 0) return;
    keep_beside(rays, map, missing);
    const std::vector<float> textures = search_.textures(missing, partners_[v]);
    for (std::size_t i = 0; i < missing.size(); ++i)
      if (textures[i] >= kLeastTexture) rays.push_back(missing[i]);
    findings.resize(rays.size());
  }

  /// Of `missing` the rays at most bare_reach rays, along both axes, from one that meets the
  /// surface.
  void keep_beside(std::span<const Ray> meeting, const RayMap& map,
                   std::vector<Ray>& missing) const {
    // Sums over the lattice from its corner: those of four corners tell whether a square holds any.
    std::vector<int> sums(std::size_t(map.width + 1) * (map.height + 1));
    const auto at = [&](int x, int y) -> int& {
      return sums[std::size_t(y) * (map.width + 1) + x];
    };
    for (const Ray& ray : meeting) at(ray.x + 1, ray.y + 1) = 1;
    for (int y = 1; y <= map.height; ++y)
      for (int x = 1; x <= map.width; ++x)
        at(x, y) += at(x - 1, y) + at(x, y - 1) - at(x - 1, y - 1);
    const int reach = options_.bare_reach;
    std::erase_if(missing, [&](const Ray& ray) {
      const int left = std::max(ray.x - reach, 0), right = std::min(ray.x + reach + 1, map.width);
      const int top = std::max(ray.y - reach, 0), low = std::min(ray.y + reach + 1, map.height);
      return at(right, low) - at(left, low) - at(right, top) + at(left, top) == 0;
    });
  }

  double confidence(double score) const {
    return std::clamp((score - options_.least_score) / 0.3, 0.0, 1.0);
  }

  /// The ray's say: what it shows lies `along` voxels from its start.
  void tell(std::size_t v, const Ray& ray, double along, double weight, RayMap& map) const {
    const std::size_t at = std::size_t(ray.y) * map.width + ray.x;
    map.depth[at] = float((glm::dot(ray.from - cameras_[v].centre, ray.direction) + along) *
                          ray.depth_per_length);
    map.weight[at] = float(weight);
    if (!surface_ || !(weight > 0)) return;
    if (ray.surface < 0 || along < ray.surface - kBeside)
      map.before.push_back(glm::vec3(ray.from + along * ray.direction));
    if (ray.surface >= 0 && along > ray.surface + kBeside)
      for (double t = ray.surface; t < along - 1; t += 1)
        map.through.push_back(glm::vec3(ray.from + t * ray.direction));
  }

  const SparseVolume& hull_;
  const SparseVolume* surface_;
  const VoteOptions& options_;
  std::vector<std::uint8_t> clear_;  // by the hull's table: clear_space
  std::span<const Camera> sources_;  // world units
  bool in_parts_;
  std::vector<projtex::GridCamera> cameras_;
  std::vector<ViewPartners> partners_;
  RaySearch search_;
};

/// View by view, so that memory is that of one view's rays.
constexpr double kHiddenBy = 2;  // voxels before what a ray found that something hides it

/// Forgets what a view's rays cannot have found, for something beside the surface hides it.
void forget_hidden(const DepthMap& beside, const projtex::GridCamera& camera, double voxel_size,
                   RayMap& map) {
  const auto is_hidden = [&](const glm::dvec2& pixel, double depth) {
    return double(beside.at(pixel)) < (depth - kHiddenBy) * voxel_size;
  };
  const auto hides = [&](const glm::vec3& point) {
    const glm::dvec3 q = camera.projection * glm::dvec4(glm::dvec3(point), 1);
    return is_hidden(glm::dvec2(q) / q.z, q.z);
  };
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const std::size_t i = std::size_t(row) * std::size_t(map.width) + std::size_t(column);
      if (map.weight[i] > 0 && is_hidden(map.pixel(column, row), double(map.depth[i])))
        map.weight[i] = 0;
    }
  std::erase_if(map.before, hides);
  std::erase_if(map.through, hides);
}

std::vector<RayMap> map_views(gpu::Context& context, const SparseVolume& hull,
                              const SparseVolume* surface, const projtex::Photographs& photographs,
                              const VoteOptions& options, SharedWork* shared) {
  const std::size_t views = photographs.cameras.size();
  const ViewMapper map_of = ray_mapper(context, hull, surface, photographs, options);
  if (shared && shared->is_open())
    return map_in_tasks(*shared, context.device().renderer, {hull, surface, options}, views,
                        map_of);
  std::vector<RayMap> maps;
  for (std::size_t v = 0; v < views; ++v) maps.push_back(map_of(v));
  if (!photographs.beside.empty()) {
    const std::vector<projtex::GridCamera> cameras =
        projtex::to_grid(photographs.cameras, hull.grid);
    for (std::size_t v = 0; v < views; ++v)
      forget_hidden(photographs.beside[v], cameras[v], hull.grid.voxel_size, maps[v]);
  }
  return maps;
}

}  // namespace

ViewMapper ray_mapper(gpu::Context& context, const SparseVolume& hull, const SparseVolume* surface,
                      const projtex::Photographs& photographs, const VoteOptions& options) {
  const auto mapper =
      std::make_shared<const RayMapper>(context, hull, surface, photographs, options);
  return [mapper](std::size_t view) { return mapper->map_of(view); };
}

std::vector<RayMap> match_rays(gpu::Context& context, const SparseVolume& hull,
                               const projtex::Photographs& photographs, const VoteOptions& options,
                               SharedWork* shared) {
  return map_views(context, hull, nullptr, photographs, options, shared);
}

std::vector<RayMap> match_rays_again(gpu::Context& context, const SparseVolume& hull,
                                     const SparseVolume& surface,
                                     const projtex::Photographs& photographs,
                                     const VoteOptions& options, SharedWork* shared) {
  return map_views(context, hull, &surface, photographs, options, shared);
}

}  // namespace photohull::refine
