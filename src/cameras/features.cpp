#include "cameras/features.h"

#include <opencv2/features2d.hpp>
#include <utility>

#include "photo/grey_image.h"

namespace photohull {

Features detect_features(const PreparedView& view, int count) {
  // Its image is doubled first, which in this version of OpenCV moves it by a quarter pixel.
  constexpr double kShift = 0.25;
  constexpr double kContrast = 0.01;  // low, for plain surfaces: matches are checked in many ways
  Features features;
  GreyImage grey = grey_image(view.image);
  cv::Mat bytes, mask;
  cv::Mat(grey.height, grey.width, CV_32F, grey.values.data()).convertTo(bytes, CV_8U);
  if (!view.mask.empty()) {
    const cv::Mat coverage(view.mask.height, view.mask.width, CV_8U,
                           const_cast<std::uint8_t*>(view.mask.coverage.data()));
    mask = coverage >= 128;
  }
  std::vector<cv::KeyPoint> points;
  cv::SIFT::create(count, 3, kContrast)
      ->detectAndCompute(bytes, mask, points, features.descriptors);
  for (const cv::KeyPoint& p : points)
    features.pixels.emplace_back(p.pt.x - kShift, p.pt.y - kShift);
  features.grey = smoothed(std::move(grey));
  return features;
}

}  // namespace photohull
