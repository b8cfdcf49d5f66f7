#include "carving/missing_parts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/clip_ray.h"
#include "core/error.h"
#include "core/photographed.h"
#include "masks/mask_lines.h"
#include "masks/outline_probe.h"
#include "masks/silhouette.h"

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
constexpr int kNotFar = 3;                // pixels around these
constexpr double kCoarse = 4;             // pixels of a ray that are given up as one
constexpr double kSafety = 0.8;           // of the distance to an outline that a ray may skip
constexpr double kFarthestSkip = 4;       // pixels: likelihoods change from place to place
constexpr double kDeep = 0.1;             // pixels within an outline: there is nothing to mend
constexpr double kBorne = 0.35;           // pixels beside an outline that are no disagreement
constexpr double kShare = 0.25;           // of the depth within an outline, along a ray there
constexpr int kHintSteps = 8;
constexpr double kNeighbour = 6;     // pixels
constexpr std::size_t kPiece = 128;  // places
constexpr int kFewestViews = 4;
constexpr std::uint8_t kBeside = 1, kNear = 2;  // marks

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
    for (std::size_t v = 0; v < cameras.size(); ++v)
      probes_.emplace_back(cameras[v], silhouettes[v].distance);
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
      for (int i = 0; i <= 2 * kHintSteps; ++i) {
        const int step = i % 2 == 0 ? i / 2 : -(i + 1) / 2;
        const double t = near->depth * (1 + step * seed.finest * ray.footprint);
        double beside = 0;
        if (rejected_by(ray.at(t), last, beside) > 0 || beside >= -kDeep) continue;
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

  /// Marks the surroundings of unexplained places of a view, and what is not far from these.
  void mark(std::size_t view, std::span<const Seed> seeds) {
    if (marks_.size() != cameras_.size()) marks_.resize(cameras_.size());
    const SilhouetteDistance& d = *silhouettes_[view].distance;
    for (const Seed& seed : seeds) {
      if (seed.explained) continue;
      if (marks_[view].empty()) marks_[view].resize(d.pixels.size());
      const int px = int(std::lround(seed.pixel.x)), py = int(std::lround(seed.pixel.y));
      const int near = kNeighbourhood + int(seed.radius), reach = near + kNotFar;
      for (int y = std::max(py - reach, 0); y <= std::min(py + reach, d.height - 1); ++y)
        for (int x = std::max(px - reach, 0); x <= std::min(px + reach, d.width - 1); ++x) {
          const bool is_near = std::max(std::abs(x - px), std::abs(y - py)) <= near;
          std::uint8_t& mark = marks_[view][std::size_t(y) * std::size_t(d.width) + x];
          mark = std::max(mark, is_near ? kNear : kBeside);
        }
    }
  }

  /// The place along the ray that most views bear.
  std::optional<MissingPart> place(std::size_t view, const Seed& seed) const {
    const Ray ray = ray_of(view, seed.pixel);
    const auto part = clip_ray(box_, ray.origin, ray.direction);
    if (!part) return std::nullopt;
    std::optional<MissingPart> best;
    double best_score = 0;
    for (double t = begin_of(*part); t < part->second;) {
      const double pixel = t * ray.footprint, half = 0.5 * kCoarse * pixel, end = t + 2 * half;
      double skip = 0;
      const bool hopeless = judge(ray.at(t + half), half, skip) <= best_score;
      if (hopeless)
        t = std::max(end, t + half + std::min(skip, kFarthestSkip * pixel));
      else
        for (; t < end && t < part->second; t += std::max(skip, seed.step * pixel)) {
          const double score = judge(ray.at(t), 0, skip);
          skip = std::min(skip, kFarthestSkip * pixel);
          if (!(score > best_score)) continue;
          best_score = score;
          best = MissingPart{ray.at(t), seed.radius * pixel};
        }
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
  /// Steps are pixels wide, and those at a camera that stands in the box have no width.
  static double begin_of(const std::pair<double, double>& part) {
    constexpr double kNearest = 0.01;  // of the farthest depth
    return std::max(part.first, kNearest * part.second);
  }

  std::optional<MissingPart> look_along(const Ray& ray, const std::pair<double, double>& part,
                                        double finest, std::size_t& last, Seed& seed) const {
    double least = kBorne, where = 0;
    for (double t = begin_of(part); t < part.second;) {
      const dvec3 p = ray.at(t);
      double beside = 0;
      const double skip = rejected_by(p, last, beside);
      if (skip <= 0) {
        seed.explained = true;
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

  /// Was the place not photographed, or is the foreground of a mask that was made little more than
  /// a guess there?
  bool is_doubtful(std::size_t view, const dvec2& pixel) const {
    const Silhouette& s = silhouettes_[view];
    const int x = std::clamp(int(std::lround(pixel.x)), 0, s.distance->width - 1);
    const int y = std::clamp(int(std::lround(pixel.y)), 0, s.distance->height - 1);
    if (s.image && !is_photographed(*s.image, x, y)) return true;
    if (!s.likelihood || !s.mask) return false;
    return s.mask->coverage[std::size_t(y) * std::size_t(s.mask->width) + x] < kSureForeground;
  }

  /// 0 where every view bears the point; else the world distance within which the view that
  /// rejects it goes on doing so. `last`: the view that is asked first, and that rejected it.
  /// `beside`: signed pixels by which the point lies outside the outline of the view that bears it
  /// least, if all do.
  double rejected_by(const dvec3& p, std::size_t& last, double& beside) const {
    beside = -1e30;
    Appearance at;
    for (std::size_t i = 0; i <= probes_.size(); ++i) {
      const std::size_t v = i == 0 ? last : i - 1;
      if (!probes_[v].has_outline() || !probes_[v].sees(p, at)) continue;
      const double d = probes_[v].distance(at);
      beside = std::max(beside, d);
      if (d <= kBorne) continue;
      last = v;
      return std::max(kSafety * d * at.depth / cameras_[v].intrinsics.fx, 1e-300);
    }
    return 0;
  }

  /// How many views show unexplained foreground at the point, less twice those that leave it out;
  /// 0 where it must not be taken. With `around`, a world distance, an upper bound for all points
  /// within it. `skip`: the world distance within which the views that leave it out go on doing so;
  /// 0: unknown.
  double judge(const dvec3& p, double around, double& skip) const {
    int seen = 0, support = 0;
    double missing = 0, lasting = 0, lasts = INFINITY;  // lasting: by views that go on doing so
    skip = 0;
    const double most = options_.most_missing * double(cameras_.size());
    Appearance at;
    for (std::size_t v = 0; v < probes_.size(); ++v) {
      if (!probes_[v].has_outline() || !probes_[v].sees(p, at)) continue;
      ++seen;
      const double per_pixel = kSafety * at.depth / cameras_[v].intrinsics.fx;  // world distance
      const double slack = around / per_pixel;
      const double d = probes_[v].distance(at) - slack;
      if (d > kBorne) {
        const double miss =
            background(v, at) * std::min((d - kBorne) / (options_.full_miss - kBorne), 1.0);
        missing += miss;
        if (const double far = d - options_.full_miss; far > kBorne) {
          lasting += miss;
          lasts = std::min(lasts, (far + slack) * per_pixel);
        }
        if (missing > most) {
          if (lasting > most) skip = lasts;
          return 0;
        }
      }
      support += slack > kNotFar || mark_at(v, at) >= (around > 0 ? kBeside : kNear);
    }
    if (seen < kFewestViews || missing > options_.most_missing * seen ||
        support < std::max(double(options_.least_support), options_.support_share * seen))
      return 0;
    return std::max(double(support) - 2 * missing, 0.0) + 1e-3;
  }

  /// How sure the view's mask is that it shows background at the point, [0, 1]: its coverage there
  /// is the chance of the opposite.
  double background(std::size_t v, const Appearance& at) const {
    const Mask* mask = silhouettes_[v].mask;
    if (!mask || mask->empty()) return 1;
    return std::max(1 - mask->coverage[probes_[v].nearest_pixel(at)] / 127.5, 0.0);
  }

  std::uint8_t mark_at(std::size_t v, const Appearance& at) const {
    return marks_[v].empty() ? 0 : marks_[v][probes_[v].nearest_pixel(at)];
  }

  Box box_;
  std::span<const Silhouette> silhouettes_;
  MissingOptions options_;
  std::span<const Camera> cameras_;
  std::vector<OutlineProbe> probes_;
  std::vector<std::vector<std::uint8_t>> marks_;  ///< by view: kNear or kBeside what is unexplained
};

/// The nearest of these places whose depth is known, if it is near enough to tell anything.
const Seed* nearest_known(std::span<const Seed> seeds, const Seed& to) {
  const Seed* best = nullptr;
  double within = to.reach * to.reach;
  for (const Seed& seed : seeds) {
    const dvec2 apart = seed.pixel - to.pixel;
    const double squared = glm::dot(apart, apart);
    if (seed.depth > 0 && squared < within) within = squared, best = &seed;
  }
  return best;
}

/// Raises the coverage to that of a disc. Was it less anywhere?
bool draw_disc(const dvec2& centre, double radius, Mask& mask) {
  const double reach = radius + 0.5;
  bool raised = false;
  for (int y = std::max(0, int(std::ceil(centre.y - reach)));
       y <= std::min(mask.height - 1, int(std::floor(centre.y + reach))); ++y)
    for (int x = std::max(0, int(std::ceil(centre.x - reach)));
         x <= std::min(mask.width - 1, int(std::floor(centre.x + reach))); ++x) {
      const double share = std::clamp(0.5 + radius - glm::distance(dvec2(x, y), centre), 0.0, 1.0);
      std::uint8_t& value = mask.coverage[std::size_t(y) * std::size_t(mask.width) + x];
      const auto drawn = std::uint8_t(std::lround(255 * share));
      raised = raised || drawn > value;
      value = std::max(value, drawn);
    }
  return raised;
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
    ForegroundCounts& counts = result.views[v];
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
                     const SilhouetteDistance& distance, const Mending& mending, Mask& mask) {
  bool mended = false;
  for (const MissingPart& part : parts) {
    const auto pixel = camera.project(part.centre);
    if (!pixel || !camera.on_image(*pixel)) continue;
    if (interpolated(distance, *pixel) < mending.from) continue;
    const double depth = camera.to_camera(part.centre).z;
    const double radius = part.radius * camera.intrinsics.fx / depth + mending.room;
    mended = draw_disc(*pixel, radius, mask) || mended;
  }
  return mended;
}

}  // namespace photohull::carving
