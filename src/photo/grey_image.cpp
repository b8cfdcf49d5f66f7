#include "photo/grey_image.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace photohull {
namespace {

float brightness(const ColourImage& image, int x, int y) {
  glm::vec3 c;
  if (image.encoding == ColourImage::Encoding::kSrgb8) {
    const std::uint8_t* p = &image.bytes[(std::size_t(y) * image.width + x) * 4];
    c = glm::vec3(p[0], p[1], p[2]);
  } else {
    const glm::vec4 linear = image.linear(x, y);
    for (int i = 0; i < 3; ++i)
      c[i] = float(255 * srgb_from_linear(std::clamp(double(linear[i]), 0.0, 1.0)));
  }
  return 0.299f * c.r + 0.587f * c.g + 0.114f * c.b;
}

}  // namespace

GreyImage grey_image(const ColourImage& image) {
  GreyImage grey{image.width, image.height,
                 std::vector<float>(std::size_t(image.width) * std::size_t(image.height))};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      grey.values[std::size_t(y) * image.width + x] = brightness(image, x, y);
  return grey;
}

GreyImage smoothed(GreyImage image) {
  constexpr double kBlur = 0.7;  // pixels
  cv::Mat pixels(image.height, image.width, CV_32F, image.values.data());
  cv::GaussianBlur(pixels, pixels, {}, kBlur);
  return image;
}

}  // namespace photohull
