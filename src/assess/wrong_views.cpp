#include "assess/wrong_views.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/clip_ray.h"
#include "core/median.h"
#include "masks/outline_probe.h"

namespace photohull::assess {
namespace {

constexpr int kRays = 400;               // a view, about
constexpr double kTolerance = 2;         // pixels, and at least
constexpr double kTolerantShare = 0.01;  // of the image's longer side
constexpr double kConsistent = 0.002;    // of the rays may stay empty
constexpr double kLeastDrop = 0.15;      // of the empty rays, by one view's removal
constexpr double kLeftOver = 0.4;        // of the rays empty at first, or kConsistent
constexpr std::size_t kFewestViews = 4;  // that must agree against one
constexpr double kOutlying = 5;          // times the other views' median gain
constexpr double kAround = 2;            // sizes of the box: what may stand beside it
constexpr int kMostSteps = 1024;         // along a ray

/// The views that reject a point, one bit each.
using ViewSet = std::vector<std::uint64_t>;

bool holds(const ViewSet& set, std::size_t view) { return set[view / 64] >> (view % 64) & 1; }

/// A ray on which no point is accepted by all views: the views that reject its points.
struct EmptyRay {
  std::size_t view = 0;
  std::vector<ViewSet> rejected_by;
};

class Silhouettes {
 public:
  Silhouettes(const Box& box, std::span<const Camera> cameras,
              std::span<const SilhouetteDistance* const> distances)
      : box_(box), cameras_(cameras), distances_(distances) {
    for (std::size_t v = 0; v < cameras.size(); ++v) {
      probes_.emplace_back(cameras[v], distances[v]);
      tolerances_.push_back(distances[v] ? tolerance_of(*distances[v]) : 0);
    }
  }

  bool known(std::size_t view) const { return distances_[view] != nullptr; }

  double tolerance(std::size_t view) const { return tolerances_[view]; }

  /// Is the point on background in the view, beyond the tolerance? Not where it is off the image.
  bool rejects(std::size_t view, const glm::dvec3& point) const {
    Appearance at;
    return probes_[view].has_outline() && probes_[view].sees(point, at) &&
           probes_[view].nearest_distance(at) > tolerances_[view];
  }

  /// The view's rays that meet the box and are empty; `count` takes how many meet it. What the
  /// silhouette shows there may stand beside the box: such rays are not empty.
  std::vector<EmptyRay> empty_rays(std::size_t view, std::size_t& count) const {
    const SilhouetteDistance& d = *distances_[view];
    const double margin = tolerance(view);
    const auto foreground =
        std::count_if(d.pixels.begin(), d.pixels.end(), [&](float p) { return p < -margin; });
    const int step = std::max(1, int(std::sqrt(double(foreground) / kRays)));
    std::vector<EmptyRay> found;
    std::size_t last = view;  // what rejected the last point often rejects the next
    for (int y = step / 2; y < d.height; y += step)
      for (int x = step / 2; x < d.width; x += step) {
        if (!(d.pixels[std::size_t(y) * d.width + x] < -margin)) continue;
        const std::vector<glm::dvec3> points = points_along(box_, view, {x, y});
        if (points.empty()) continue;
        ++count;
        if (std::all_of(points.begin(), points.end(),
                        [&](const glm::dvec3& p) { return rejected(p, last); }) &&
            !shows_something_around(view, {x, y}))
          found.push_back({view, rejecters(points)});
      }
    return found;
  }

 private:
  static double tolerance_of(const SilhouetteDistance& d) {
    return std::max(kTolerance, kTolerantShare * std::max(d.width, d.height));
  }

  /// So close that a part that other views show twice the tolerance wide is not stepped over.
  std::vector<glm::dvec3> points_along(const Box& box, std::size_t view,
                                       const glm::dvec2& pixel) const {
    const Camera& camera = cameras_[view];
    const glm::dvec3 origin = camera.center(), ray = camera.ray(pixel);
    std::vector<glm::dvec3> points;
    const auto part = clip_ray(box, origin, ray);
    if (!part) return points;
    const double footprint = 0.5 * (part->first + part->second) / camera.intrinsics.fx;
    const double length = part->second - part->first;
    const int steps =
        std::clamp(int(std::ceil(length / (1.5 * tolerance(view) * footprint))), 2, kMostSteps);
    for (int i = 0; i < steps; ++i)
      points.push_back(origin + (part->first + length * (i + 0.5) / steps) * ray);
    return points;
  }

  /// Does the ray pass, beside the box, through what nobody rejects and half of the views see?
  bool shows_something_around(std::size_t view, const glm::dvec2& pixel) const {
    const glm::dvec3 middle = 0.5 * (box_.min + box_.max), half = 0.5 * kAround * box_.size();
    const std::vector<glm::dvec3> points =
        points_along({middle - half, middle + half}, view, pixel);
    std::size_t last = view;
    return std::any_of(points.begin(), points.end(), [&](const glm::dvec3& p) {
      return !box_.contains(p) && !rejected(p, last) && seen_by(p) >= cameras_.size() / 2;
    });
  }

  std::size_t seen_by(const glm::dvec3& point) const {
    std::size_t count = 0;
    Appearance at;
    for (const OutlineProbe& probe : probes_) count += probe.has_outline() && probe.sees(point, at);
    return count;
  }

  bool rejected(const glm::dvec3& point, std::size_t& last) const {
    if (rejects(last, point)) return true;
    for (std::size_t v = 0; v < cameras_.size(); ++v)
      if (v != last && rejects(v, point)) {
        last = v;
        return true;
      }
    return false;
  }

  std::vector<ViewSet> rejecters(std::span<const glm::dvec3> points) const {
    std::vector<ViewSet> sets;
    for (const glm::dvec3& p : points) {
      ViewSet set((cameras_.size() + 63) / 64);
      for (std::size_t v = 0; v < cameras_.size(); ++v)
        if (rejects(v, p)) set[v / 64] |= std::uint64_t(1) << (v % 64);
      // Neighbours on the ray are mostly rejected by the same views.
      if (sets.empty() || sets.back() != set) sets.push_back(std::move(set));
    }
    return sets;
  }

  const Box& box_;
  std::span<const Camera> cameras_;
  std::span<const SilhouetteDistance* const> distances_;
  std::vector<OutlineProbe> probes_;
  std::vector<double> tolerances_;  ///< pixels
};

/// Which views' rays stay empty when some views are taken out.
class Ballot {
 public:
  Ballot(const Silhouettes& silhouettes, std::size_t views) : rays_(views), removed_(views) {
    std::vector<std::vector<EmptyRay>> found(views);
    tbb::parallel_for(std::size_t(0), views, [&](std::size_t v) {
      if (silhouettes.known(v)) found[v] = silhouettes.empty_rays(v, rays_[v]);
    });
    for (std::vector<EmptyRay>& rays : found)
      for (EmptyRay& ray : rays) empty_.push_back(std::move(ray));
  }

  /// Share of the rays of the views that are left.
  double uncovered() const {
    double rays = 0, empty = 0;
    for (std::size_t v = 0; v < rays_.size(); ++v) rays += removed_[v] ? 0 : double(rays_[v]);
    for (const EmptyRay& ray : empty_) empty += !removed_[ray.view];
    return rays > 0 ? empty / rays : 0;
  }

  /// For each view, how many rays of the others would not be empty without it.
  std::vector<int> gains() const {
    std::vector<int> gains(rays_.size());
    for (const EmptyRay& ray : empty_) {
      if (removed_[ray.view]) continue;
      std::vector<char> helps(rays_.size());
      for (const ViewSet& set : ray.rejected_by)
        if (const auto only = only_one_left(set)) helps[*only] = true;
      for (std::size_t v = 0; v < helps.size(); ++v) gains[v] += v != ray.view && helps[v];
    }
    return gains;
  }

  void remove(std::size_t view) {
    removed_[view] = true;
    std::erase_if(empty_, [&](const EmptyRay& ray) {
      return std::any_of(ray.rejected_by.begin(), ray.rejected_by.end(),
                         [&](const ViewSet& set) { return nobody_left(set); });
    });
  }

 private:
  std::optional<std::size_t> only_one_left(const ViewSet& set) const {
    std::optional<std::size_t> only;
    for (std::size_t v = 0; v < rays_.size(); ++v)
      if (holds(set, v) && !removed_[v]) {
        if (only) return std::nullopt;
        only = v;
      }
    return only;
  }
  bool nobody_left(const ViewSet& set) const {
    for (std::size_t v = 0; v < rays_.size(); ++v)
      if (holds(set, v) && !removed_[v]) return false;
    return true;
  }

  std::vector<std::size_t> rays_;  ///< a view each
  std::vector<char> removed_;
  std::vector<EmptyRay> empty_;
};

}  // namespace

SilhouetteConsistency find_wrong_views(const Box& box, std::span<const Camera> cameras,
                                       std::span<const SilhouetteDistance* const> silhouettes) {
  const Silhouettes known(box, cameras, silhouettes);
  Ballot ballot(known, cameras.size());
  SilhouetteConsistency result;
  result.uncovered = result.uncovered_left = ballot.uncovered();
  std::size_t left = std::size_t(std::count_if(silhouettes.begin(), silhouettes.end(),
                                               [](const auto* d) { return d != nullptr; }));
  const std::size_t most = left / 4;
  std::vector<int> removed;
  double uncovered = result.uncovered;
  while (uncovered > kConsistent && removed.size() < most && left > kFewestViews) {
    const std::vector<int> gains = ballot.gains();
    const auto worst = std::max_element(gains.begin(), gains.end()) - gains.begin();
    if (gains[std::size_t(worst)] <= kOutlying * median({gains.begin(), gains.end()})) break;
    ballot.remove(std::size_t(worst));
    const double after = ballot.uncovered();
    if (after > (1 - kLeastDrop) * uncovered) break;
    removed.push_back(int(worst));
    uncovered = after;
    --left;
  }
  if (!removed.empty() && uncovered <= std::max(kConsistent, kLeftOver * result.uncovered)) {
    std::sort(removed.begin(), removed.end());
    result.wrong = std::move(removed);
    result.uncovered_left = uncovered;
  }
  return result;
}

}  // namespace photohull::assess
