// Based on: A. Gruen, "Adaptive least squares correlation", 1985 [Gruen85].
#include "assess/match_probes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/median.h"
#include "photo/grey_image.h"

namespace photohull::assess {
namespace {

constexpr double kLeastAngle = 5, kMostAngle = 50;  // degrees between two views at the point
constexpr int kOthers = 2;                          // views in which a patch is looked for
// Between two views' pixels: patches have too few of the larger ones to be placed well.
constexpr double kMostScale = 1.6;
constexpr int kNeighbours = 12;     // of a probe, with itself
constexpr double kSameSide = 0.5;   // cosine between their normals
constexpr double kConfirmed = 0.4;  // of the neighbours

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)) * 180 /
         std::numbers::pi;
}

/// Where the tangent plane puts the patch around `pixel` of camera a in camera b.
std::optional<PatchPlace> place_in(const Camera& a, const glm::dvec2& pixel, const Camera& b,
                                   const SurfaceProbe& probe) {
  const auto seen = [&](const glm::dvec2& p) -> std::optional<glm::dvec2> {
    const glm::dvec3 ray = a.ray(p);
    const double depth =
        glm::dot(probe.point - a.center(), probe.normal) / glm::dot(ray, probe.normal);
    return b.project(a.center() + depth * ray);
  };
  const auto middle = seen(pixel), x = seen(pixel + glm::dvec2(1, 0)),
             y = seen(pixel + glm::dvec2(0, 1));
  if (!middle || !x || !y) return std::nullopt;
  return PatchPlace{*middle, glm::dmat2(*x - *middle, *y - *middle)};
}

/// Has the patch gradients in two directions, and do they stand out of rounding and noise?
bool textured(const GreyImage& image, const glm::dvec2& pixel, const MatchOptions& options) {
  constexpr double kLeastGradient =
      1.0;                               // levels a pixel, root mean square in the weaker direction
  constexpr double kLeftOfNoise = 0.45;  // by the smoothing of GreyImage
  constexpr double kSignalToNoise = 2;   // so that the correlation can come to 0.8
  double xx = 0, xy = 0, yy = 0, sum = 0, squares = 0;
  int n = 0;
  for (int y = -options.radius; y <= options.radius; ++y)
    for (int x = -options.radius; x <= options.radius; ++x, ++n) {
      const glm::dvec2 p = pixel + glm::dvec2(x, y);
      if (!image.holds(p.x - 1, p.y - 1) || !image.holds(p.x + 1, p.y + 1)) return false;
      const double gx = 0.5 * (image.at(p.x + 1, p.y) - image.at(p.x - 1, p.y));
      const double gy = 0.5 * (image.at(p.x, p.y + 1) - image.at(p.x, p.y - 1));
      const double value = image.at(p.x, p.y);
      xx += gx * gx, xy += gx * gy, yy += gy * gy;
      sum += value, squares += value * value;
    }
  const double half = 0.5 * (xx + yy);
  const double weaker = half - std::sqrt(std::max(0.0, half * half - (xx * yy - xy * xy)));
  const double deviation = std::sqrt(std::max(0.0, squares / n - sum * sum / n / n));
  return weaker > n * kLeastGradient * kLeastGradient &&
         deviation > kSignalToNoise * kLeftOfNoise * options.noise;
}

struct Match {
  int a = 0, b = 0;       // views
  double across = 0;      // pixels from the epipolar line
  double offset = 0;      // world units along the normal
  double pixel_size = 0;  // world units, of the coarser of the two views
  bool fine = true;       // is that small enough, and of nearly the other's size?
};

struct ProbeResult {
  bool seen = false, textured = false;
  std::vector<Match> matches;

  /// Two views that agree on the surface outweigh one that does not.
  std::optional<double> least_offset() const {
    std::optional<double> least;
    for (const Match& m : matches)
      if (m.fine) least = std::min(least.value_or(INFINITY), m.offset);
    return least;
  }
};

class Matcher {
 public:
  Matcher(std::span<const PreparedView> views,
          std::span<const SilhouetteDistance* const> silhouettes, const MatchOptions& options)
      : views_(views), silhouettes_(silhouettes), options_(options), grey_(views.size()) {
    tbb::parallel_for(std::size_t(0), views.size(),
                      [&](std::size_t i) { grey_[i] = smoothed(grey_image(views[i].image)); });
  }

  ProbeResult operator()(const SurfaceProbe& probe) const {
    ProbeResult result;
    if (probe.views.empty()) return result;
    const int a = probe.views.front();
    const Camera& camera = views_[a].camera;
    const glm::dvec2 pixel = camera.project(probe.point).value();
    const std::vector<int> others = choose(probe);
    result.seen = !others.empty();
    result.textured = result.seen && within(a, pixel) && textured(grey_[a], pixel, options_);
    if (!result.textured) return result;
    bool placed = false;
    for (const int b : others) {
      const auto start = place_in(camera, pixel, views_[b].camera, probe);
      if (!start || !(glm::determinant(start->shape) > 0.1) || !within(b, start->center)) continue;
      placed = true;
      const auto found =
          align_patch(grey_[a], pixel, grey_[b], *start, options_.radius, options_.farthest);
      if (found && found->agreement >= options_.least_agreement)
        if (const auto match = measure(probe, a, pixel, b, *start, found->place.center))
          result.matches.push_back(*match);
    }
    result.textured = placed;
    return result;
  }

 private:
  /// The views nearest in angle to the first, beyond the least angle.
  std::vector<int> choose(const SurfaceProbe& probe) const {
    const glm::dvec3 first = views_[probe.views.front()].camera.center() - probe.point;
    std::vector<std::pair<double, int>> by_angle;
    for (const int v : probe.views) {
      const double angle = degrees_between(first, views_[v].camera.center() - probe.point);
      if (angle >= kLeastAngle && angle <= kMostAngle) by_angle.emplace_back(angle, v);
    }
    std::sort(by_angle.begin(), by_angle.end());
    std::vector<int> others;
    for (const auto& [angle, v] : by_angle)
      if (int(others.size()) < kOthers) others.push_back(v);
    return others;
  }

  /// Does the patch lie on the silhouette, as far as that is known?
  bool within(int view, const glm::dvec2& pixel) const {
    const SilhouetteDistance* d = silhouettes_[view];
    if (!d) return true;
    const int x = int(std::lround(pixel.x)), y = int(std::lround(pixel.y));
    return x >= 0 && y >= 0 && x < d->width && y < d->height &&
           d->pixels[std::size_t(y) * d->width + x] < -options_.radius;
  }

  /// World units that a pixel covers at the probe.
  static double footprint_of(const Camera& camera, const SurfaceProbe& probe) {
    return glm::dot(probe.point - camera.center(), camera.forward()) / camera.intrinsics.fx;
  }

  std::optional<Match> measure(const SurfaceProbe& probe, int a, const glm::dvec2& pixel, int b,
                               const PatchPlace& start, const glm::dvec2& found) const {
    const Camera &from = views_[a].camera, &to = views_[b].camera;
    const glm::dvec3 ray = from.ray(pixel);
    // A step that moves the patch by about a pixel.
    const double footprint = footprint_of(to, probe);
    const auto moved = to.project(probe.point + footprint * ray);
    if (!moved) return std::nullopt;
    const glm::dvec2 along = *moved - start.center;  // pixels for a footprint along the ray
    const double length = glm::length(along);
    if (!(length > 0.02)) return std::nullopt;
    const glm::dvec2 shift = found - start.center;
    Match match{a, b};
    const double other = footprint_of(from, probe);
    match.pixel_size = std::max(footprint, other);
    match.fine = match.pixel_size < options_.coarsest &&
                 match.pixel_size < kMostScale * std::min(footprint, other);
    match.across = std::abs(along.x * shift.y - along.y * shift.x) / length;
    match.offset = std::abs(glm::dot(along, shift) / (length * length) * footprint *
                            glm::dot(ray, probe.normal));
    return match;
  }

  std::span<const PreparedView> views_;
  std::span<const SilhouetteDistance* const> silhouettes_;
  const MatchOptions& options_;
  std::vector<GreyImage> grey_;
};

/// Share of the probes around which the surface is not confirmed: of the textured ones near it, on
/// the same side, most were not found again or lie far off.
double unconfirmed_patches(std::span<const SurfaceProbe> probes,
                           std::span<const ProbeResult> results, double far) {
  std::vector<std::size_t> textured;
  std::vector<char> confirmed(probes.size());
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (!results[i].textured) continue;
    textured.push_back(i);
    confirmed[i] = !results[i].matches.empty() && results[i].least_offset().value_or(0) <= far;
  }
  std::vector<char> doubted(probes.size());
  tbb::parallel_for(std::size_t(0), textured.size(), [&](std::size_t k) {
    const SurfaceProbe& probe = probes[textured[k]];
    std::vector<std::pair<double, std::size_t>> near;
    for (const std::size_t other : textured) {
      if (glm::dot(probes[other].normal, probe.normal) < kSameSide) continue;
      const glm::dvec3 way = probes[other].point - probe.point;
      near.emplace_back(glm::dot(way, way), other);
    }
    if (near.size() < kNeighbours) return;
    std::nth_element(near.begin(), near.begin() + kNeighbours - 1, near.end());
    const auto end = near.begin() + kNeighbours;
    const auto found =
        std::count_if(near.begin(), end, [&](const auto& n) { return bool(confirmed[n.second]); });
    doubted[textured[k]] = double(found) < kConfirmed * kNeighbours;
  });
  return double(std::ranges::count(doubted, 1)) / double(std::max<std::size_t>(1, probes.size()));
}

/// Distances from epipolar lines, by views and over all.
void sum_up_cameras(std::span<const ProbeResult> results, std::size_t views,
                    MatchEvidence& evidence) {
  std::vector<double> across, sizes;
  std::vector<std::vector<double>> by_view(views), sizes_by_view(views);
  evidence.views.resize(views);
  for (const ProbeResult& r : results) {
    for (const Match& m : r.matches) {
      if (!m.fine) continue;
      across.push_back(m.across);
      sizes.push_back(m.pixel_size);
      for (const int view : {m.a, m.b}) {
        by_view[view].push_back(m.across);
        sizes_by_view[view].push_back(m.pixel_size);
      }
    }
  }
  evidence.residual = median(across);
  evidence.pixel_size = median(sizes);
  for (std::size_t i = 0; i < views; ++i) {
    evidence.views[i].pixels = median(by_view[i]);
    evidence.views[i].pixel_size = median(sizes_by_view[i]);
    evidence.views[i].matches = int(by_view[i].size());
  }
}

}  // namespace

MatchEvidence match_probes(std::span<const SurfaceProbe> probes,
                           std::span<const PreparedView> views,
                           std::span<const SilhouetteDistance* const> silhouettes,
                           const MatchOptions& options) {
  const Matcher matcher(views, silhouettes, options);
  std::vector<ProbeResult> results(probes.size());
  tbb::parallel_for(std::size_t(0), probes.size(),
                    [&](std::size_t i) { results[i] = matcher(probes[i]); });
  MatchEvidence evidence;
  std::vector<double> offsets;
  double seen = 0, textured = 0, matched = 0;
  for (const ProbeResult& r : results) {
    seen += r.seen, textured += r.textured, matched += !r.matches.empty();
    if (const auto offset = r.least_offset()) offsets.push_back(*offset);
  }
  const double n = std::max<double>(1, double(probes.size()));
  evidence.seen = seen / n;
  evidence.textured = textured / n;
  evidence.matched = textured > 0 ? matched / textured : 0;
  evidence.unconfirmed_patches = unconfirmed_patches(probes, results, options.far);
  const auto share_beyond = [&](double limit) {
    return offsets.empty() ? 0.0
                           : double(std::count_if(offsets.begin(), offsets.end(),
                                                  [&](double o) { return o > limit; })) /
                                 double(offsets.size());
  };
  evidence.beyond_near = share_beyond(options.near);
  evidence.beyond_far = share_beyond(options.far);
  evidence.offset = median(offsets);
  sum_up_cameras(results, views.size(), evidence);
  return evidence;
}

}  // namespace photohull::assess
