#include "calib/features.h"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace photohull {
namespace {

cv::Mat grey_of(const ColourImage& image) {
  cv::Mat grey(image.height, image.width, CV_32F);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      glm::vec3 c;
      if (image.encoding == ColourImage::Encoding::kSrgb8) {
        const std::uint8_t* p = &image.bytes[(std::size_t(y) * image.width + x) * 4];
        c = glm::vec3(p[0], p[1], p[2]);
      } else {
        const glm::vec4 linear = image.linear(x, y);
        for (int i = 0; i < 3; ++i)
          c[i] = float(255 * srgb_from_linear(std::clamp(double(linear[i]), 0.0, 1.0)));
      }
      grey.at<float>(y, x) = 0.299f * c.r + 0.587f * c.g + 0.114f * c.b;
    }
  return grey;
}

}  // namespace

Features detect_features(const View& view, int count) {
  // Its image is doubled first, which in this version of OpenCV moves it by a quarter pixel.
  constexpr double kShift = 0.25;
  constexpr double kContrast = 0.01;  // low, for plain surfaces: matches are checked in many ways
  constexpr double kBlur = 0.7;       // pixels: bilinear interpolation errs less on smooth images
  Features features;
  const cv::Mat grey = grey_of(view.image);
  cv::Mat bytes, mask;
  grey.convertTo(bytes, CV_8U);
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
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {}, kBlur);
  features.grey = {smooth.cols, smooth.rows, {}};
  features.grey.values.assign(smooth.ptr<float>(), smooth.ptr<float>() + smooth.total());
  return features;
}

}  // namespace photohull
