#include "masks/photographed_mask.h"

#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/photographed.h"

namespace photohull {

Mask photographed_mask(const ColourImage& image, const Mask& mask) {
  constexpr int kNear = 64;  // pixels
  constexpr std::uint8_t kHalf = 128;
  if (!image.has_alpha || image.bytes.empty() || mask.empty()) return mask;
  PHOTOHULL_CHECK(image.width == mask.width && image.height == mask.height);
  Mask out = mask;
  cv::Mat coverage(mask.height, mask.width, CV_8U, out.coverage.data());
  cv::Mat beside(coverage.size(), CV_8U);
  for (int y = 0; y < beside.rows; ++y)
    for (int x = 0; x < beside.cols; ++x)
      beside.at<std::uint8_t>(y, x) = is_photographed(image, x, y) ? 0 : 255;
  if (cv::countNonZero(beside) == 0) return out;
  cv::Mat near;
  cv::dilate((coverage >= kHalf) & ~beside, near,
             cv::getStructuringElement(cv::MORPH_RECT, {2 * kNear + 1, 2 * kNear + 1}));
  coverage.setTo(0, beside & ~near);
  return out;
}

}  // namespace photohull
