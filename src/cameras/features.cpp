#include "cameras/features.h"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "photo/grey_image.h"

namespace photohull {
namespace {

constexpr int kEnough = 200;  // features that a quick search must find

/// Where the mask has something, and a margin: the border disturbs features near it.
cv::Rect around_foreground(const cv::Mat& mask) {
  constexpr int kMargin = 48;  // pixels
  const cv::Rect tight = cv::boundingRect(mask);
  const cv::Rect wide(tight.x - kMargin, tight.y - kMargin, tight.width + 2 * kMargin,
                      tight.height + 2 * kMargin);
  return tight.empty() ? tight : wide & cv::Rect({0, 0}, mask.size());
}

/// Features of an image that is `times` smaller, in pixels of the image itself.
Features detect_smaller(const cv::Mat& image, const cv::Mat& mask, int times, int count) {
  // Its image is doubled first, which in this version of OpenCV moves it by a quarter pixel.
  constexpr double kShift = 0.25;
  constexpr double kContrast = 0.01;  // low, for plain surfaces: matches are checked in many ways
  if (std::min(image.cols, image.rows) < times) return {};
  cv::Mat small, small_mask;
  cv::resize(image, small, image.size() / times, 0, 0, cv::INTER_AREA);
  if (!mask.empty()) cv::resize(mask, small_mask, small.size(), 0, 0, cv::INTER_NEAREST);
  std::vector<cv::KeyPoint> points;
  Features found;
  found.times = times;
  cv::SIFT::create(count, 3, kContrast)
      ->detectAndCompute(small, small_mask, points, found.descriptors);
  for (const cv::KeyPoint& p : points) {
    const glm::dvec2 middle(p.pt.x - kShift + 0.5, p.pt.y - kShift + 0.5);
    found.pixels.push_back(middle * double(times) - 0.5);
  }
  return found;
}

}  // namespace

Features detect_features(const PreparedView& view, int count, FeatureSearch search) {
  const int longest = search == FeatureSearch::kCoarse ? 400 : 1600;  // pixels
  GreyImage grey = grey_image(view.image);
  cv::Mat image, mask;
  cv::Mat(grey.height, grey.width, CV_32F, grey.values.data()).convertTo(image, CV_8U);
  cv::Rect part({0, 0}, image.size());
  if (!view.mask.empty()) {
    const cv::Mat coverage(view.mask.height, view.mask.width, CV_8U,
                           const_cast<std::uint8_t*>(view.mask.coverage.data()));
    mask = coverage >= 128;
    part = around_foreground(mask);
    mask = mask(part);
  }
  image = image(part);
  const int times = std::max(1, (std::max(part.width, part.height) + longest - 1) / longest);
  Features found;
  if (search == FeatureSearch::kQuick) found = detect_smaller(image, mask, 2 * times, count);
  if (search != FeatureSearch::kQuick || int(found.pixels.size()) < kEnough)
    found = detect_smaller(image, mask, times, count);
  for (glm::dvec2& pixel : found.pixels) pixel += glm::dvec2(part.x, part.y);
  found.grey = smoothed(std::move(grey));
  return found;
}

}  // namespace photohull
