#include "carving/confirm_lines.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/clip_ray.h"
#include "core/error.h"
#include "masks/line_chains.h"
#include "masks/mask_lines.h"
#include "masks/outline_probe.h"
#include "masks/silhouette.h"

namespace photohull::carving {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kStep = 0.35;          // pixels between points of a ray
constexpr double kCoarse = 4;           // pixels of a ray that are given up as one
constexpr double kSafety = 0.8;         // of the distance to an outline that a ray may skip
constexpr double kBorne = 0.35;         // pixels beside an outline that are no disagreement
constexpr double kFullMiss = 2;         // pixels beside an outline that are a full one
constexpr double kNear = 1.5;           // pixels from a line that passes through a place
constexpr double kSameDirection = 0.3;  // sine of the angle between a direction and a line's plane
constexpr double kTwoPlanes = 0.15;     // sine of the angle between planes that meet in a direction
constexpr double kForeshortened = 0.3;  // least sine between a direction and the line of sight
constexpr int kFewestViews = 4;
constexpr std::size_t kStride = 4;
constexpr double kNeighbour = 6;  // pixels
constexpr int kHintSteps = 8;
constexpr int kMostSteps = 64;
constexpr double kLink = 2.5;    // pixels between neighbours on a line
constexpr double kAlong = 0.87;  // cosine of the angle between these
constexpr int kMostRounds = 6;
constexpr double kSettled = 0.01;  // of the candidates that a round drops

/// A view's candidates, to be found by their place.
class Candidates {
 public:
  Candidates(const std::vector<LinePoint>& points, int height) : points_(points) {
    order_.resize(points.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      const int ra = row_of(points[a]), rb = row_of(points[b]);
      return ra != rb ? ra < rb : points[a].x != points[b].x ? points[a].x < points[b].x : a < b;
    });
    first_.assign(std::size_t(height) + 2, 0);
    for (const LinePoint& p : points)
      ++first_[std::size_t(std::clamp(row_of(p), 0, height - 1)) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  }

  /// Index of the point nearest to a pixel, if there is one within so many.
  std::optional<std::size_t> nearest(double x, double y, double within) const {
    std::optional<std::size_t> best;
    double least = within * within;
    const int last = int(first_.size()) - 3;
    for (int row = std::max(int(std::floor(y - within)), 0);
         row <= std::min(int(std::ceil(y + within)), last); ++row) {
      const auto end = order_.begin() + first_[std::size_t(row) + 1];
      auto from = std::lower_bound(order_.begin() + first_[std::size_t(row)], end, x - within,
                                   [&](std::uint32_t i, double v) { return points_[i].x < v; });
      for (; from != end && points_[*from].x <= x + within; ++from) {
        const LinePoint& p = points_[*from];
        const double squared = (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
        if (squared < least) least = squared, best = *from;
      }
    }
    return best;
  }

 private:
  static int row_of(const LinePoint& p) { return int(std::lround(p.y)); }

  const std::vector<LinePoint>& points_;
  std::vector<std::uint32_t> order_, first_;
};

/// The views at one round.
class Round {
 public:
  Round(const Box& box, std::span<const Camera> cameras, std::span<const Silhouette> silhouettes,
        const std::vector<std::vector<LinePoint>>& lines, const ConfirmOptions& options)
      : box_(box), cameras_(cameras), lines_(lines), options_(options), all_(cameras.size()) {
    tbb::parallel_for(std::size_t(0), cameras.size(), [&](std::size_t v) {
      if (!silhouettes[v].distance) return;
      Mask mask = *silhouettes[v].mask;
      widen_lines(lines[v], mask);
      all_[v] = silhouette_distance(mask);
    });
    for (std::size_t v = 0; v < cameras.size(); ++v) {
      const bool known = silhouettes[v].distance;
      probes_.emplace_back(cameras[v], known ? &all_[v] : nullptr);
      masks_.emplace_back(cameras[v], silhouettes[v].distance);
      index_.emplace_back(lines[v], cameras[v].intrinsics.height);
    }
  }

  /// Which of the view's candidates stand somewhere: of each line every kStride-th is looked for,
  /// and the others where one of these stands.
  std::vector<LinePoint> confirmed(std::size_t view, std::vector<dvec3>& places) const {
    const std::vector<LinePoint>& points = lines_[view];
    const std::vector<std::uint32_t> line = lines_of(points);
    std::vector<std::uint32_t> count(points.size(), 0);
    std::vector<std::uint8_t> first(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) first[i] = count[line[i]]++ % kStride == 0;
    std::vector<double> depth(points.size(), 0);
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
      if (first[i]) depth[i] = search(view, points[i]);
    });
    std::vector<LinePoint> standing;
    std::vector<double> depths;
    std::vector<std::uint8_t> stands(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      if (depth[i] > 0)
        standing.push_back(points[i]), depths.push_back(depth[i]), stands[line[i]] = 1;
    const Candidates beside(standing, cameras_[view].intrinsics.height);
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
      if (first[i] || !stands[line[i]]) return;
      const auto near = beside.nearest(points[i].x, points[i].y, kNeighbour);
      depth[i] = search(view, points[i], near ? depths[*near] : 0);
    });
    grow(view, depth);
    std::vector<LinePoint> out;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (depth[i] > 0) {
        out.push_back(points[i]);
        const Camera& camera = cameras_[view];
        places.push_back(camera.center() + depth[i] * camera.ray({points[i].x, points[i].y}));
      }
    return out;
  }

 private:
  /// A point on the ray of a candidate, to be asked whether it stands.
  struct Ray {
    std::size_t view = 0;
    dvec3 origin, direction, plane;
    bool continues = false;  ///< the mask
  };

  /// Lines go on from where they stand, as far as most views have anything there: a leaf that is
  /// seen on edge here shows its broad side to others, and no line.
  void grow(std::size_t view, std::vector<double>& depth) const {
    const std::vector<LinePoint>& points = lines_[view];
    std::vector<double> found(points.size());
    for (bool grows = true; grows;) {
      std::vector<LinePoint> standing;
      std::vector<double> depths;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (depth[i] > 0) standing.push_back(points[i]), depths.push_back(depth[i]);
      const Candidates beside(standing, cameras_[view].intrinsics.height);
      tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
        found[i] = 0;
        if (depth[i] > 0) return;
        const auto near = beside.nearest(points[i].x, points[i].y, kLink);
        if (!near || !along(points[i], standing[*near])) return;
        Ray ray = ray_of(view, points[i]);
        ray.continues = true;
        if (const auto part = clip_ray(box_, ray.origin, ray.direction))
          found[i] = look_near(ray, *part, depths[*near]);
      });
      grows = false;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (found[i] > 0) depth[i] = found[i], grows = true;
    }
  }

  static bool along(const LinePoint& a, const LinePoint& b) {
    return std::abs(a.normal_x * b.normal_x + a.normal_y * b.normal_y) > kAlong;
  }

  Ray ray_of(std::size_t view, const LinePoint& line) const {
    const Camera& camera = cameras_[view];
    return {view, camera.center(), camera.ray({line.x, line.y}), plane_of(view, line),
            masks_[view].distance({line.x, line.y, 0}) <= options_.continues_mask};
  }

  /// Where the ray's candidate stands beside `near`; 0: nowhere.
  double look_near(const Ray& ray, const std::pair<double, double>& part, double near) const {
    const double footprint = 1 / cameras_[ray.view].intrinsics.fx;
    for (int i = 0; i <= 2 * kHintSteps; ++i) {
      const int step = i % 2 == 0 ? i / 2 : -(i + 1) / 2;
      const double t = near * (1 + step * kStep * footprint);
      double skip;
      if (t > part.first && t < part.second && stands(ray, t, skip)) return t;
    }
    return 0;
  }

  /// Where along the ray, in the box, the candidate stands; 0: nowhere. `near`: where a neighbour
  /// does.
  double search(std::size_t view, const LinePoint& line, double near = 0) const {
    const Ray ray = ray_of(view, line);
    const auto part = clip_ray(box_, ray.origin, ray.direction);
    if (!part) return 0;
    if (near > 0)
      if (const double t = look_near(ray, *part, near); t > 0) return t;
    const double footprint = 1 / cameras_[view].intrinsics.fx;
    for (double t = part->first; t < part->second;) {
      const double pixel = t * footprint, half = 0.5 * kCoarse * pixel, end = t + 2 * half;
      if (hopeless(ray.origin + (t + half) * ray.direction, half))
        t = end;
      else
        for (double skip = 0; t < end && t < part->second; t += std::max(kStep * pixel, skip))
          if (stands(ray, t, skip)) return middle(ray, t, part->second);
    }
    return 0;
  }

  /// Of the part of the ray from `from` on, up to `end`, where the candidate stands.
  double middle(const Ray& ray, double from, double end) const {
    const double step = kStep * from / cameras_[ray.view].intrinsics.fx;
    double skip, last = from;
    for (int i = 1; i <= kMostSteps && from + i * step < end; ++i) {
      if (!stands(ray, from + i * step, skip)) break;
      last = from + i * step;
    }
    return 0.5 * (from + last);
  }

  /// Normal of the plane through the camera and the line, world axes.
  dvec3 plane_of(std::size_t view, const LinePoint& line) const {
    const dvec2 at(line.x, line.y), along(-line.normal_y, line.normal_x);
    return glm::normalize(
        glm::cross(cameras_[view].ray(at - along), cameras_[view].ray(at + along)));
  }

  /// Do too many views leave out every point within a world distance?
  bool hopeless(const dvec3& p, double around) const {
    double missing = 0;
    int seen = 0;
    Appearance at;
    for (std::size_t v = 0; v < probes_.size(); ++v) {
      if (!probes_[v].has_outline() || !probes_[v].sees(p, at)) continue;
      ++seen;
      const double slack = around * cameras_[v].intrinsics.fx / (kSafety * at.depth);
      missing += miss(probes_[v].distance(at) - slack);
      if (missing > options_.most_missing * double(probes_.size())) return true;
    }
    return missing > options_.most_missing * seen;
  }

  static double miss(double distance) {
    return std::clamp((distance - kBorne) / (kFullMiss - kBorne), 0.0, 1.0);
  }

  /// `skip`: the part of the ray from here on, as a difference of t, where too many views go on
  /// leaving it out; 0: unknown.
  bool stands(const Ray& ray, double t, double& skip) const {
    const dvec3 p = ray.origin + t * ray.direction;
    const double most = options_.most_missing * double(probes_.size());
    double lasting = 0, lasts = INFINITY;
    skip = 0;
    double missing = 0;
    int seen = 0;
    thread_local std::vector<dvec3> planes;
    planes.clear();
    Appearance at;
    for (std::size_t v = 0; v < probes_.size(); ++v) {
      if (!probes_[v].has_outline() || !probes_[v].sees(p, at)) continue;
      ++seen;
      if (v == ray.view) continue;
      const double d = probes_[v].distance(at);
      missing += miss(d);
      if (d > kFullMiss) {
        lasting += 1;
        lasts = std::min(lasts, (d - kFullMiss) * at.depth / cameras_[v].intrinsics.fx);
      }
      if (missing > most) {
        if (lasting > most) skip = kSafety * lasts / glm::length(ray.direction);
        return false;
      }
      if (d > kBorne || masks_[v].distance(at) <= kBorne) continue;
      if (const auto line = index_[v].nearest(at.x, at.y, kNear))
        planes.push_back(plane_of(v, lines_[v][*line]));
    }
    if (seen < kFewestViews || missing > options_.most_missing * seen) return false;
    if (ray.continues) return true;
    const double least = std::max(double(options_.least_support), options_.support_share * seen);
    if (1 + double(planes.size()) < least) return false;
    // The direction in which most of the planes meet this line's.
    const dvec3 sight = glm::normalize(ray.direction);
    int agree = 0;
    for (const dvec3& other : planes) {
      const dvec3 cross = glm::cross(ray.plane, other);
      const double length = glm::length(cross);
      if (length < kTwoPlanes) continue;
      const dvec3 direction = cross / length;
      if (glm::length(glm::cross(direction, sight)) < kForeshortened) continue;
      const auto along = std::count_if(planes.begin(), planes.end(), [&](const dvec3& n) {
        return std::abs(glm::dot(n, direction)) < kSameDirection;
      });
      agree = std::max(agree, int(along));
    }
    const double astray = double(planes.size()) - agree;
    return 1 + agree >= least && missing + astray <= options_.most_missing * seen;
  }

  Box box_;
  std::span<const Camera> cameras_;
  const std::vector<std::vector<LinePoint>>& lines_;
  ConfirmOptions options_;
  std::vector<SilhouetteDistance> all_;  ///< to masks and candidates
  std::vector<OutlineProbe> probes_, masks_;
  std::vector<Candidates> index_;
};

}  // namespace

ConfirmedLines confirm_lines(const Box& box, std::span<const Camera> cameras,
                             std::span<const Silhouette> silhouettes,
                             std::vector<std::vector<LinePoint>> candidates,
                             const ConfirmOptions& options, Progress* progress) {
  PHOTOHULL_CHECK_OP(cameras.size(), ==, silhouettes.size());
  PHOTOHULL_CHECK_OP(cameras.size(), ==, candidates.size());
  for (std::size_t v = 0; v < candidates.size(); ++v)
    if (!silhouettes[v].distance) candidates[v].clear();
  std::vector<dvec3> places;
  for (int round = 0; round < kMostRounds; ++round) {
    if (progress) progress->check_cancelled();
    const Round views(box, cameras, silhouettes, candidates, options);
    std::vector<std::vector<LinePoint>> kept(candidates.size());
    std::size_t before = 0, after = 0;
    places.clear();
    for (std::size_t v = 0; v < candidates.size(); ++v) {
      if (progress) progress->check_cancelled();
      kept[v] = views.confirmed(v, places);
      before += candidates[v].size(), after += kept[v].size();
    }
    candidates = std::move(kept);
    if (double(before - after) <= kSettled * double(before)) break;
  }
  return {std::move(candidates), std::move(places)};
}

}  // namespace photohull::carving
