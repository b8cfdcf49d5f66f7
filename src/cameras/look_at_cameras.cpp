#include "cameras/look_at_cameras.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "cameras/diagnose_parts.h"
#include "cameras/features.h"
#include "cameras/free_matches.h"
#include "cameras/frontier.h"
#include "cameras/near_views.h"
#include "cameras/residuals.h"
#include "core/median.h"

namespace photohull {
namespace {

constexpr std::size_t kPairs = 6;
constexpr int kFeatures = 400;            // a view
constexpr double kLargestAngle = 45;      // degrees
constexpr double kTolerance = 1.5;        // pixels of the images that features are found in
constexpr std::size_t kMostAligned = 60;  // of a pair
constexpr std::size_t kFewestAligned = 8;

std::vector<Camera> cameras_of(std::span<const PreparedView> views) {
  std::vector<Camera> cameras;
  for (const PreparedView& view : views) cameras.push_back(view.camera);
  return cameras;
}

/// Neighbours, begun with views that are spread over all; each pair once.
std::vector<std::pair<int, int>> some_pairs(std::span<const Camera> cameras) {
  std::set<std::pair<int, int>> pairs;
  const std::size_t n = cameras.size(), wanted = std::min(kPairs, n);
  for (std::size_t k = 0; k < wanted; ++k) {
    const int view = int(k * n / wanted);
    for (const int other : nearest_views(cameras, view, 1, kLargestAngle))
      pairs.emplace(std::minmax(view, other));
  }
  return {pairs.begin(), pairs.end()};
}

/// Places of features found in smaller images, in the photographs themselves; those whose
/// surroundings do not agree go.
PixelPairs aligned(const PixelPairs& matches, const Features& a, const Features& b) {
  constexpr int kRadius = 7;  // pixels
  constexpr double kAgreement = 0.8;
  const double farthest = 2.0 * std::max(a.times, b.times);
  const std::size_t step = (matches.size() + kMostAligned - 1) / kMostAligned;
  PixelPairs result;
  for (std::size_t i = 0; i < matches.size(); i += step) {
    const auto& [p, q] = matches[i];
    const auto found = align_patch(a.grey, p, b.grey, {q, glm::dmat2(1.0)}, kRadius, farthest);
    if (found && found->agreement >= kAgreement) result.emplace_back(p, found->place.center);
  }
  return result;
}

}  // namespace

FeatureAgreement look_at_features(std::span<const PreparedView> views, Progress& progress) {
  const std::vector<Camera> cameras = cameras_of(views);
  const std::vector<std::pair<int, int>> pairs = some_pairs(cameras);
  std::set<int> looked_at;
  for (const auto& [a, b] : pairs) looked_at.insert({a, b});
  const std::vector<int> list(looked_at.begin(), looked_at.end());
  std::vector<Features> features(views.size());
  tbb::parallel_for(std::size_t(0), list.size(), [&](std::size_t i) {
    const std::size_t view = std::size_t(list[i]);
    if (!progress.cancelled())
      features[view] = detect_features(views[view], kFeatures, FeatureSearch::kCoarse);
  });
  progress.check_cancelled();
  std::vector<PixelPairs> found(pairs.size());
  tbb::parallel_for(std::size_t(0), pairs.size(), [&](std::size_t i) {
    const Features &a = features[std::size_t(pairs[i].first)],
                   &b = features[std::size_t(pairs[i].second)];
    found[i] = aligned(match_freely(a, b, kTolerance * std::max(a.times, b.times)), a, b);
  });
  FeatureAgreement result;
  std::vector<double> medians;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (found[i].size() < kFewestAligned) continue;
    std::vector<double> residuals;
    for (const auto& [p, q] : found[i])
      residuals.push_back(
          diagnosis::epipolar_residual(cameras, pairs[i].first, pairs[i].second, p, q));
    medians.push_back(median(std::move(residuals)));
    ++result.pairs;
    result.matches += int(found[i].size());
  }
  if (!medians.empty()) result.pixels = median(std::move(medians));
  return result;
}

double tangent_disagreement(std::span<const PreparedView> views) {
  return tangent_disagreement(cameras_of(views), outlines_of(views));
}

double tangent_disagreement(std::span<const Camera> cameras, std::span<const Outline> outlines) {
  const std::vector<double> distances =
      tangent_distances(cameras, frontier_pairs(cameras, outlines));
  return distances.empty() ? NAN : median(distances);
}

double pixels_off(std::span<const PreparedView> views, Progress& progress) {
  const double tangents = tangent_disagreement(views);
  const double off = std::isfinite(tangents) ? tangents : look_at_features(views, progress).pixels;
  return std::isfinite(off) ? off : 0;
}

}  // namespace photohull
