#include "calib/shrink.h"

#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace photohull {

Camera resized(const Camera& camera, int width, int height) {
  Camera out = camera;
  Intrinsics& k = out.intrinsics;
  const double x = double(width) / k.width, y = double(height) / k.height;
  k.fx *= x, k.skew *= x, k.fy *= y;
  k.cx = (k.cx + 0.5) * x - 0.5;  // the frame's edge is half a pixel from the first one's centre
  k.cy = (k.cy + 0.5) * y - 0.5;
  k.width = width, k.height = height;
  return out;
}

ColourImage shrink(const ColourImage& image, int width, int height) {
  PHOTOHULL_CHECK_OP(width, <=, image.width);
  PHOTOHULL_CHECK_OP(height, <=, image.height);
  if (width == image.width && height == image.height) return image;
  ColourImage out{width, height, image.encoding, image.has_alpha, {}};
  out.bytes.resize(std::size_t(width) * height * out.bytes_per_pixel());
  const bool srgb = image.encoding == ColourImage::Encoding::kSrgb8;
  const int type = srgb ? CV_8UC4 : CV_16FC4;
  const cv::Mat from(image.height, image.width, type,
                     const_cast<std::uint8_t*>(image.bytes.data()));
  cv::Mat to(height, width, type, out.bytes.data());
  if (srgb) {
    cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
    return out;
  }
  cv::Mat floats, small;  // halves cannot be resized
  from.convertTo(floats, CV_32F);
  cv::resize(floats, small, to.size(), 0, 0, cv::INTER_AREA);
  small.convertTo(to, CV_16F);
  return out;
}

Mask shrink(const Mask& mask, int width, int height) {
  if (width == mask.width && height == mask.height) return mask;
  Mask out{width, height, {}};
  out.coverage.resize(std::size_t(width) * height);
  const cv::Mat from(mask.height, mask.width, CV_8U,
                     const_cast<std::uint8_t*>(mask.coverage.data()));
  cv::Mat to(height, width, CV_8U, out.coverage.data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
  return out;
}

}  // namespace photohull
