#include "cameras/look_at_cameras.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
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
#include "photo/grey_image.h"

namespace photohull {
namespace {

constexpr std::size_t kPairs = 6;
constexpr int kLongest = 1600;        // pixels of a side: larger photographs are looked at smaller
constexpr int kFeatures = 400;        // a view
constexpr double kLargestAngle = 45;  // degrees
constexpr double kSuspiciousFeatures = 0.25;  // pixels of photographs that are no larger
constexpr double kTolerance = 1.5;            // pixels of the images that features are found in
constexpr double kStill = 0.5;            // such pixels: the background of a turntable stands still
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

int times_too_large(const PreparedView& view) {
  return (std::max(view.image.width, view.image.height) + kLongest - 1) / kLongest;
}

/// Means of squares of `times` x `times` pixels; what is left at the right and below goes.
cv::Mat smaller(const cv::Mat& pixels, int times) {
  const cv::Size size = pixels.size() / times;
  cv::Mat small;
  cv::resize(pixels(cv::Rect({0, 0}, size * times)), small, size, 0, 0, cv::INTER_AREA);
  return small;
}

std::vector<std::uint8_t> bytes_of(const cv::Mat& pixels) {
  return {pixels.datastart, pixels.dataend};
}

/// The photograph and its mask, so many times smaller.
PreparedView smaller(const PreparedView& view, int times) {
  cv::Mat pixels;
  if (view.image.encoding == ColourImage::Encoding::kSrgb8) {
    pixels = smaller(cv::Mat(view.image.height, view.image.width, CV_8UC4,
                             const_cast<std::uint8_t*>(view.image.bytes.data())),
                     times);
  } else {
    GreyImage grey = grey_image(view.image);
    cv::Mat levels = smaller(cv::Mat(grey.height, grey.width, CV_32F, grey.values.data()), times);
    levels.convertTo(levels, CV_8U);
    cv::merge(std::vector<cv::Mat>(4, levels), pixels);
  }
  PreparedView small;
  small.image = {pixels.cols, pixels.rows};
  small.image.bytes = bytes_of(pixels);
  if (view.mask.empty()) return small;
  const cv::Mat coverage(view.mask.height, view.mask.width, CV_8U,
                         const_cast<std::uint8_t*>(view.mask.coverage.data()));
  small.mask = {pixels.cols, pixels.rows, bytes_of(smaller(coverage, times))};
  return small;
}

/// Features of a photograph, in pixels of one that is `times` smaller.
Features features_of(const PreparedView& view, int times) {
  if (times > 1) return detect_features(smaller(view, times), kFeatures, FeatureSearch::kCoarse);
  return detect_features(view, kFeatures, FeatureSearch::kCoarse);
}

/// Where both photographs show the same.
PixelPairs common_places(const PreparedView& view_a, const PreparedView& view_b) {
  const int times_a = times_too_large(view_a), times_b = times_too_large(view_b);
  const Features a = features_of(view_a, times_a), b = features_of(view_b, times_b);
  const double pixel = std::max(a.times, b.times);  // of the images that features are found in
  // Masks keep features off the background.
  const bool masked = !view_a.mask.empty() && !view_b.mask.empty();
  const double least_motion = masked ? 0 : kStill * pixel;
  PixelPairs places = aligned(match_freely(a, b, kTolerance * pixel, least_motion), a, b);
  for (auto& [p, q] : places) {
    p = (p + 0.5) * double(times_a) - 0.5;
    q = (q + 0.5) * double(times_b) - 0.5;
  }
  return places;
}

}  // namespace

FeatureAgreement look_at_features(std::span<const PreparedView> views, Progress& progress) {
  const std::vector<Camera> cameras = cameras_of(views);
  const std::vector<std::pair<int, int>> pairs = some_pairs(cameras);
  std::vector<std::vector<double>> residuals(pairs.size());
  tbb::parallel_for(std::size_t(0), pairs.size(), [&](std::size_t i) {
    if (progress.cancelled()) return;
    const auto [a, b] = pairs[i];
    for (const auto& [p, q] : common_places(views[std::size_t(a)], views[std::size_t(b)]))
      residuals[i].push_back(diagnosis::epipolar_residual(cameras, a, b, p, q));
  });
  progress.check_cancelled();
  FeatureAgreement result;
  std::vector<double> medians;
  for (std::vector<double>& of_pair : residuals) {
    if (of_pair.size() < kFewestAligned) continue;
    ++result.pairs;
    result.matches += int(of_pair.size());
    medians.push_back(median(std::move(of_pair)));
  }
  if (medians.empty()) return result;
  result.pixels = median(std::move(medians));
  for (const PreparedView& view : views)
    result.suspicious = std::max(result.suspicious, kSuspiciousFeatures * times_too_large(view));
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
