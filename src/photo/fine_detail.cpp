#include "photo/fine_detail.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace photohull {
namespace {

constexpr double kFine = 0.7, kCoarse = 2.8;  // Gaussians, pixels
constexpr double kLeastEnergy = 0.05;         // squared levels a pixel: less is no texture

/// Mean of the squared gradient of the blurred picture.
double energy(const cv::Mat& grey, double sigma) {
  cv::Mat blurred, x, y;
  cv::GaussianBlur(grey, blurred, {}, sigma);
  cv::Sobel(blurred, x, CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(blurred, y, CV_32F, 0, 1, 1, 0.5);
  return (cv::norm(x, cv::NORM_L2SQR) + cv::norm(y, cv::NORM_L2SQR)) / double(grey.total());
}

}  // namespace

double fine_detail(const GreyImage& grey) {
  const cv::Mat pixels(grey.height, grey.width, CV_32F, const_cast<float*>(grey.values.data()));
  const double coarse = energy(pixels, kCoarse);
  return coarse < kLeastEnergy ? 0 : std::sqrt(energy(pixels, kFine) / coarse);
}

}  // namespace photohull
