#include "carving/missing_parts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "calib/silhouette.h"
#include "core/clip_ray.h"
#include "core/error.h"

namespace photohull::carving {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kAround = 2;  // sizes of the box: what masks show may stand beside it
// Pixels between points of a ray: that are looked at for one that all views bear, of a line, and of
// another place at the second look; that are judged, of a line, and of another place.
constexpr double kFinest = 0.15, kFiner = 0.35;
constexpr double kLineStep = 0.35, kLatticeStep = 0.7;
constexpr double kInside = 1.5;  // pixels within an outline from where on foreground is searched
constexpr int kLatticePlaces = 400;       // a view, about
constexpr std::size_t kMostLines = 6000;  // a view
constexpr int kNeighbourhood = 2;         // pixels around unexplained foreground that count as such
constexpr double kSafety = 0.8;           // of the distance to an outline that a ray may skip
constexpr double kFarthestSkip = 4;       // pixels: likelihoods change from place to place
constexpr double kDeep = 0.1;             // pixels within an outline: there is nothing to mend
constexpr double kRoom = 0.75;   // pixels around a part in the silhouettes that it is put into
constexpr double kBorne = 0.35;  // pixels beside an outline that are no disagreement
constexpr double kShare = 0.25;  // of the depth within an outline, along a ray there
constexpr int kHintSteps = 8;
constexpr double kNeighbour = 6;     // pixels
constexpr std::size_t kPiece = 128;  // places
constexpr std::uint8_t kSure = 192;  // of 255: the chance of a half, and half of the rest
constexpr int kFewestViews = 4;

/// A place of a view's foreground, pixels.
struct Seed {
  dvec2 pixel;
  double step = 0;    ///< between the points of its ray that are judged, pixels
  double finest = 0;  ///< between those that are looked at for one that all views bear
  double reach = 0;   ///< pixels from a place whose depth tells something of this one's
  double radius = 0;  ///< of what is put there, pixels
  bool is_line = false;
  bool explained = false;
  double depth = 0;  ///< along the ray, of the point that all views bear well; 0: none
};

class Searcher {
 public:
  Searcher(const Box& box, std::span<const Camera> cameras, std::span<const Silhouette> silhouettes,
           const MissingOptions& options)
      : box_(box), silhouettes_(silhouettes), options_(options), cameras_(cameras) {
    for (const Camera& camera : cameras) projections_.push_back(camera.projection());
  }

  /// The line's points, and a lattice within what is thicker.
  std::vector<Seed> seeds(std::size_t view) const {
    const SilhouetteDistance& d = *silhouettes_[view].distance;
    std::vector<Seed> out;
    if (const auto* lines = silhouettes_[view].lines) {
      const std::size_t stride = lines->size() / kMostLines + 1;
      for (std::size_t i = 0; i < lines->size(); i += stride) {
        const LinePoint& p = (*lines)[i];
        if (is_doubtful(view, {p.x, p.y})) continue;
        out.push_back({{p.x, p.y}, kLineStep, kFinest, kNeighbour, 0.5 * p.width, true});
      }
    }
    const auto within =
        std::count_if(d.pixels.begin(), d.pixels.end(), [](float v) { return v < -kInside; });
    const int lattice = std::max(1, int(std::sqrt(double(within) / kLatticePlaces)));
    for (int y = lattice / 2; y < d.height; y += lattice)
      for (int x = lattice / 2; x < d.width; x += lattice) {
        const double inside = -double(d.pixels[std::size_t(y) * std::size_t(d.width) + x]);
        if (inside <= kInside || is_doubtful(view, dvec2(x, y))) continue;
        out.push_back({dvec2(x, y), kLatticeStep, std::max(kFinest, kShare * inside),
                       std::max(kNeighbour, 3.0 * lattice), std::min(0.75 * lattice, inside)});
      }
    return out;
  }

  /// Looks for a point of the ray, in the box or around it, that every view which sees it bears.
  /// What some view bears just so becomes a part: interpolated distances would lose it. `near`: an
  /// explained place beside this one, which is likely to be as deep.
  std::optional<MissingPart> explain(std::size_t view, Seed& seed, const Seed* near) const {
    const Ray ray = ray_of(view, seed.pixel);
    const auto part = clip_ray(box_, ray.origin, ray.direction);
    seed.explained = !part;  // nothing of it can be in the box
    if (!part) return std::nullopt;
    std::size_t last = view;
    if (near)
      for (int i = -kHintSteps; i <= kHintSteps; ++i) {
        const double t = near->depth * (1 + i * seed.finest * ray.footprint);
        if (rejected_by(ray.at(t), last) > 0 || farthest(ray.at(t)) >= -kDeep) continue;
        seed.explained = true, seed.depth = t;
        return std::nullopt;
      }
    std::optional<MissingPart> found = look_along(ray, *part, seed.finest, last, seed);
    // What is thick here may be thin for others.
    if (!seed.explained && seed.finest > kFinest)
      found = look_along(ray, *part, kFiner, last, seed);
    if (!seed.explained) {
      const dvec3 half = 0.5 * kAround * box_.size(), middle = 0.5 * (box_.min + box_.max);
      const auto around = clip_ray({middle - half, middle + half}, ray.origin, ray.direction);
      look_along(ray, *around, std::max(seed.finest, kLatticeStep), last, seed);
    }
    return seed.is_line ? found : std::nullopt;
  }

  /// Marks the surroundings of unexplained places of a view.
  void mark(std::size_t view, std::span<const Seed> seeds) {
    if (marks_.size() != cameras_.size()) marks_.resize(cameras_.size());
    const SilhouetteDistance& d = *silhouettes_[view].distance;
    for (const Seed& seed : seeds) {
      if (seed.explained) continue;
      if (marks_[view].empty()) marks_[view].resize(d.pixels.size());
      const int px = int(std::lround(seed.pixel.x)), py = int(std::lround(seed.pixel.y));
      const int reach = kNeighbourhood + int(seed.radius);
      for (int y = std::max(py - reach, 0); y <= std::min(py + reach, d.height - 1); ++y)
        for (int x = std::max(px - reach, 0); x <= std::min(px + reach, d.width - 1); ++x)
          marks_[view][std::size_t(y) * std::size_t(d.width) + x] = 1;
    }
  }

  /// The place along the ray that most views bear.
  std::optional<MissingPart> place(std::size_t view, const Seed& seed) const {
    const Ray ray = ray_of(view, seed.pixel);
    const auto part = clip_ray(box_, ray.origin, ray.direction);
    if (!part) return std::nullopt;
    std::optional<MissingPart> best;
    double best_score = 0;
    for (double t = part->first, skip = 0; t < part->second;
         t += std::max(skip, seed.step * t * ray.footprint)) {
      const dvec3 p = ray.at(t);
      const double score = judge(p, skip);
      skip = std::min(skip, kFarthestSkip * t * ray.footprint);
      if (!(score > best_score)) continue;
      best_score = score;
      best = MissingPart{p, seed.radius * t * ray.footprint};
    }
    return best;
  }

 private:
  struct Ray {
    dvec3 origin, direction;
    double footprint = 0;  ///< world size of a pixel at t = 1
    dvec3 at(double t) const { return origin + t * direction; }
  };

  /// explain() along a part of the ray, by steps of at least so many pixels. `last`: the view that
  /// is asked first.
  std::optional<MissingPart> look_along(const Ray& ray, const std::pair<double, double>& part,
                                        double finest, std::size_t& last, Seed& seed) const {
    double least = kBorne, where = 0;
    for (double t = part.first; t < part.second;) {
      const dvec3 p = ray.at(t);
      const double skip = rejected_by(p, last);
      if (skip <= 0) {
        seed.explained = true;
        const double beside = farthest(p);
        if (beside < -kDeep) {
          seed.depth = t;
          return std::nullopt;
        }
        if (beside < least && box_.contains(p)) least = beside, where = t;
      }
      t += std::max(skip, finest * t * ray.footprint);
    }
    if (where == 0) return std::nullopt;
    return MissingPart{ray.at(where), seed.radius * where * ray.footprint};
  }

  Ray ray_of(std::size_t view, const dvec2& pixel) const {
    const Camera& camera = cameras_[view];
    return {camera.center(), camera.ray(pixel), 1 / camera.intrinsics.fx};
  }

  /// Signed pixels from the view's outline; nothing where the view says nothing. `depth` as well.
  std::optional<double> outline(std::size_t v, const dvec3& p, double& depth) const {
    if (!silhouettes_[v].distance) return std::nullopt;
    const dvec3 q = projections_[v] * glm::dvec4(p, 1);
    if (q.z <= 0) return std::nullopt;
    const dvec2 pixel(q.x / q.z, q.y / q.z);
    if (!cameras_[v].on_image(pixel)) return std::nullopt;
    depth = q.z;
    return interpolated(*silhouettes_[v].distance, pixel);
  }

  /// Is the foreground of a mask that was made little more than a guess here?
  bool is_doubtful(std::size_t view, const dvec2& pixel) const {
    const Silhouette& s = silhouettes_[view];
    if (!s.likelihood || !s.mask) return false;
    const int x = std::clamp(int(std::lround(pixel.x)), 0, s.mask->width - 1);
    const int y = std::clamp(int(std::lround(pixel.y)), 0, s.mask->height - 1);
    return s.mask->coverage[std::size_t(y) * std::size_t(s.mask->width) + x] < kSure;
  }

  /// 0 where every view bears the point; else the world distance within which the view that
  /// rejects it goes on doing so. `last`: the view that is asked first, and that rejected it.
  double rejected_by(const dvec3& p, std::size_t& last) const {
    for (std::size_t i = 0; i <= cameras_.size(); ++i) {
      const std::size_t v = i == 0 ? last : i - 1;
      double depth = 0;
      const auto d = outline(v, p, depth);
      if (!d || *d <= kBorne) continue;
      last = v;
      return std::max(kSafety * *d * depth / cameras_[v].intrinsics.fx, 1e-300);
    }
    return 0;
  }

  /// Signed pixels by which the point lies outside the outline of the view that bears it least.
  double farthest(const dvec3& p) const {
    double most = -1e30, depth = 0;
    for (std::size_t v = 0; v < cameras_.size(); ++v)
      if (const auto d = outline(v, p, depth)) most = std::max(most, *d);
    return most;
  }

  /// How many views show unexplained foreground at the point, less twice those that leave it out;
  /// 0 where it must not be taken. `skip`: the world distance within which the views that leave it
  /// out go on doing so; 0: unknown.
  double judge(const dvec3& p, double& skip) const {
    int seen = 0, support = 0;
    double missing = 0, lasting = 0, lasts = INFINITY;  // lasting: by views that go on doing so
    skip = 0;
    const double most = options_.most_missing * double(cameras_.size());
    for (std::size_t v = 0; v < cameras_.size(); ++v) {
      double depth = 0;
      const auto d = outline(v, p, depth);
      if (!d) continue;
      ++seen;
      if (*d > kBorne) {
        const double miss =
            background(v, p) * std::min((*d - kBorne) / (options_.full_miss - kBorne), 1.0);
        missing += miss;
        if (const double far = *d - options_.full_miss; far > kBorne) {
          lasting += miss;
          lasts = std::min(lasts, kSafety * far * depth / cameras_[v].intrinsics.fx);
        }
        if (missing > most) {
          if (lasting > most) skip = lasts;
          return 0;
        }
      }
      support += is_marked(v, p);
    }
    if (seen < kFewestViews || missing > options_.most_missing * seen ||
        support < std::max(double(options_.least_support), options_.support_share * seen))
      return 0;
    return std::max(double(support) - 2 * missing, 0.0) + 1e-3;
  }

  /// How sure the view's mask is that it shows background at the point, [0, 1]: its coverage there
  /// is the chance of the opposite.
  double background(std::size_t v, const dvec3& p) const {
    const Mask* mask = silhouettes_[v].mask;
    if (!mask || mask->empty()) return 1;
    const dvec3 q = projections_[v] * glm::dvec4(p, 1);
    const int x = std::clamp(int(std::lround(q.x / q.z)), 0, mask->width - 1);
    const int y = std::clamp(int(std::lround(q.y / q.z)), 0, mask->height - 1);
    return std::max(1 - mask->coverage[std::size_t(y) * std::size_t(mask->width) + x] / 127.5, 0.0);
  }

  bool is_marked(std::size_t v, const dvec3& p) const {
    if (marks_[v].empty()) return false;
    const dvec3 q = projections_[v] * glm::dvec4(p, 1);
    const SilhouetteDistance& d = *silhouettes_[v].distance;
    const int x = std::clamp(int(std::lround(q.x / q.z)), 0, d.width - 1);
    const int y = std::clamp(int(std::lround(q.y / q.z)), 0, d.height - 1);
    return marks_[v][std::size_t(y) * std::size_t(d.width) + x];
  }

  Box box_;
  std::span<const Silhouette> silhouettes_;
  MissingOptions options_;
  std::span<const Camera> cameras_;
  std::vector<glm::dmat4x3> projections_;
  std::vector<std::vector<std::uint8_t>> marks_;  ///< by view: near unexplained foreground
};

/// The nearest of these places whose depth is known, if it is near enough to tell anything.
const Seed* nearest_known(std::span<const Seed> seeds, const Seed& to) {
  const Seed* best = nullptr;
  double within = to.reach;
  for (const Seed& seed : seeds) {
    const double d = glm::distance(seed.pixel, to.pixel);
    if (seed.depth > 0 && d < within) within = d, best = &seed;
  }
  return best;
}

/// Raises the coverage to that of a disc.
void draw_disc(const dvec2& centre, double radius, Mask& mask) {
  const double reach = radius + 0.5;
  for (int y = std::max(0, int(std::ceil(centre.y - reach)));
       y <= std::min(mask.height - 1, int(std::floor(centre.y + reach))); ++y)
    for (int x = std::max(0, int(std::ceil(centre.x - reach)));
         x <= std::min(mask.width - 1, int(std::floor(centre.x + reach))); ++x) {
      const double share = std::clamp(0.5 + radius - glm::distance(dvec2(x, y), centre), 0.0, 1.0);
      std::uint8_t& value = mask.coverage[std::size_t(y) * std::size_t(mask.width) + x];
      value = std::max(value, std::uint8_t(std::lround(255 * share)));
    }
}

}  // namespace

MissingParts find_missing_parts(const Box& box, std::span<const Camera> cameras,
                                std::span<const Silhouette> silhouettes,
                                const MissingOptions& options, Progress* progress) {
  PHOTOHULL_CHECK_OP(cameras.size(), ==, silhouettes.size());
  Searcher searcher(box, cameras, silhouettes, options);
  std::vector<std::vector<Seed>> seeds(cameras.size());
  std::vector<std::vector<std::optional<MissingPart>>> found(cameras.size());
  MissingParts result;
  result.views.resize(cameras.size());
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    if (progress) progress->check_cancelled();
    if (!silhouettes[v].distance) continue;
    seeds[v] = searcher.seeds(v);
    found[v].resize(seeds[v].size());
    // In pieces of fixed size, so that which neighbours are known does not depend on threads.
    tbb::parallel_for(std::size_t(0), (seeds[v].size() + kPiece - 1) / kPiece, [&](std::size_t n) {
      const std::size_t first = n * kPiece, end = std::min(first + kPiece, seeds[v].size());
      for (std::size_t i = first; i < end; ++i) {
        const Seed* near =
            nearest_known(std::span(seeds[v]).subspan(first, i - first), seeds[v][i]);
        found[v][i] = searcher.explain(v, seeds[v][i], near);
      }
    });
  }
  for (std::size_t v = 0; v < cameras.size(); ++v)
    if (silhouettes[v].distance) searcher.mark(v, seeds[v]);
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    if (progress) progress->check_cancelled();
    tbb::parallel_for(std::size_t(0), seeds[v].size(), [&](std::size_t i) {
      if (!seeds[v][i].explained) found[v][i] = searcher.place(v, seeds[v][i]);
    });
    ExplainedView& counts = result.views[v];
    counts.looked_at = int(seeds[v].size());
    for (std::size_t i = 0; i < seeds[v].size(); ++i) {
      counts.unexplained += !seeds[v][i].explained;
      counts.placed += !seeds[v][i].explained && found[v][i];
      if (found[v][i]) result.parts.push_back(*found[v][i]);
    }
  }
  return result;
}

bool mend_silhouette(std::span<const MissingPart> parts, const Camera& camera,
                     const SilhouetteDistance& distance, Mask& mask) {
  bool mended = false;
  for (const MissingPart& part : parts) {
    const auto pixel = camera.project(part.centre);
    if (!pixel || !camera.on_image(*pixel)) continue;
    if (interpolated(distance, *pixel) < -kDeep) continue;
    const double depth = camera.to_camera(part.centre).z;
    draw_disc(*pixel, part.radius * camera.intrinsics.fx / depth + kRoom, mask);
    mended = true;
  }
  return mended;
}

}  // namespace photohull::carving
