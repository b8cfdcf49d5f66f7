#include "cameras/free_matches.h"

#include <tbb/parallel_for.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

#include "cameras/features.h"

namespace photohull {
namespace {

constexpr int kFeatures = 800;     // a view
constexpr float kRatio = 0.8f;     // of the best to the second-best descriptor's distance
constexpr double kEpipolar = 1.5;  // pixels
constexpr double kConfidence = 0.99;
constexpr std::size_t kFewest = 16;  // matches of a pair

/// For every row of a the row of b that is clearly nearest; -1 where there is none.
std::vector<int> nearest(const cv::Mat& a, const cv::Mat& b) {
  std::vector<std::vector<cv::DMatch>> found;
  cv::BFMatcher(cv::NORM_L2).knnMatch(a, b, found, 2);
  std::vector<int> best(std::size_t(a.rows), -1);
  for (const auto& two : found)
    if (two.size() == 2 && two[0].distance < kRatio * two[1].distance)
      best[std::size_t(two[0].queryIdx)] = two[0].trainIdx;
  return best;
}

}  // namespace

PixelPairs match_freely(const Features& a, const Features& b, double tolerance,
                        double least_motion) {
  if (a.pixels.size() < kFewest || b.pixels.size() < kFewest) return {};
  const std::vector<int> there = nearest(a.descriptors, b.descriptors);
  const std::vector<int> back = nearest(b.descriptors, a.descriptors);
  std::vector<cv::Point2d> in_a, in_b;
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (there[i] < 0 || back[std::size_t(there[i])] != int(i)) continue;
    const glm::dvec2 &p = a.pixels[i], &q = b.pixels[std::size_t(there[i])];
    if (glm::distance(p, q) < least_motion) continue;
    in_a.emplace_back(p.x, p.y);
    in_b.emplace_back(q.x, q.y);
  }
  if (in_a.size() < kFewest) return {};
  std::vector<std::uint8_t> inliers;
  cv::findFundamentalMat(in_a, in_b, cv::FM_RANSAC, tolerance, kConfidence, inliers);
  PixelPairs found;
  for (std::size_t i = 0; i < inliers.size(); ++i)
    if (inliers[i])
      found.emplace_back(glm::dvec2(in_a[i].x, in_a[i].y), glm::dvec2(in_b[i].x, in_b[i].y));
  if (found.size() < std::max(kFewest, in_a.size() / 2)) found.clear();
  return found;
}

std::vector<PairMatches> match_without_cameras(std::span<const PreparedView> views,
                                               std::span<const std::pair<int, int>> pairs,
                                               Progress& progress) {
  std::vector<Features> features(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!progress.cancelled())
      features[i] = detect_features(views[i], kFeatures, FeatureSearch::kFull);
  });
  progress.check_cancelled();
  std::vector<PairMatches> found(pairs.size());
  tbb::parallel_for(std::size_t(0), pairs.size(), [&](std::size_t i) {
    const auto [a, b] = pairs[i];
    if (!progress.cancelled())
      found[i] = {a, b,
                  match_freely(features[std::size_t(a)], features[std::size_t(b)], kEpipolar)};
  });
  progress.check_cancelled();
  std::erase_if(found, [](const PairMatches& m) { return m.pixels.empty(); });
  return found;
}

}  // namespace photohull
