// Based on: T. Horprasert, D. Harwood, L. Davis, "A statistical approach for real-time robust
// background subtraction and shadow detection", ICCV Frame-rate workshop 1999 [Horprasert99]:
// differences in brightness and in chromaticity told apart.
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/error.h"
#include "core/median.h"
#include "masks/mask_evidence.h"

namespace photohull {

cv::Mat light_roots(const ColourImage& image) {
  cv::Mat out(image.height, image.width, CV_32FC3);
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < 256; ++i)
    table[i] = float(std::sqrt(linear_from_srgb(double(i) / 255)));
  const bool coded = image.encoding == ColourImage::Encoding::kSrgb8;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      cv::Vec3f& p = out.at<cv::Vec3f>(y, x);
      if (coded) {
        const std::uint8_t* bytes =
            &image.bytes[4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x))];
        p = {table[bytes[0]], table[bytes[1]], table[bytes[2]]};
      } else {
        const glm::vec4 c = glm::sqrt(glm::max(image.linear(x, y), 0.0f));
        p = {c.r, c.g, c.b};
      }
    }
  return out;
}

namespace {

constexpr double kFrameShare = 0.02;  // of the shorter side: width of the frame
constexpr double kMedianToSigma = 1.483;
constexpr double kLevels = 4;            // of distance in a deviation
constexpr int kWeak = 12, kStrong = 28;  // 3 and 7 deviations
constexpr float kDarkestShadow = 0.55f;  // square root of the light that is left: 30 %
constexpr double kRoughness = 1.8;       // deviations: a shadow's depth varies less around a pixel
constexpr float kLeastSigma = 0.003f;    // square roots of linear light; 8-bit rounding
constexpr float kDarkSigma = 0.012f;     // the same where it is black: codes are farther apart
constexpr float kDark = 0.08f;           // square root of linear light
constexpr float kShift = 0.25f;          // pixels by which plate and photograph may be off
constexpr float kLeastPlate = 0.05f;     // square root of linear light; darker takes no shadow

template <typename Visit>
void for_each_at_frame(const cv::Size& size, const Visit& visit) {
  const int ring = std::max(2, int(kFrameShare * std::min(size.width, size.height)));
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (x < ring || y < ring || x >= size.width - ring || y >= size.height - ring) visit(x, y);
}

/// The plate as exposed as the photograph, by the usual ratio along the frame.
void match_exposure(const cv::Mat& image, cv::Mat& plate) {
  cv::Mat smooth_image, smooth_plate;  // or noise would choose the pixels, and bias the ratio
  cv::blur(image, smooth_image, {5, 5});
  cv::blur(plate, smooth_plate, {5, 5});
  for (int c = 0; c < 3; ++c) {
    std::vector<double> ratios;
    for_each_at_frame(image.size(), [&](int x, int y) {
      const float p = smooth_plate.at<cv::Vec3f>(y, x)[c];
      if (p > kDark) ratios.push_back(smooth_image.at<cv::Vec3f>(y, x)[c] / p);
    });
    if (ratios.size() < 50) continue;
    const auto ratio = float(std::clamp(median(ratios), 0.5, 2.0));
    for (int y = 0; y < plate.rows; ++y)
      for (int x = 0; x < plate.cols; ++x) plate.at<cv::Vec3f>(y, x)[c] *= ratio;
  }
}

/// Deviation of the difference at each pixel: noise, and what an offset does to the plate's edges.
cv::Mat expected_deviation(const cv::Mat& image, const cv::Mat& plate, const cv::Mat& certain) {
  cv::Mat dx, dy;
  cv::Sobel(plate, dx, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(plate, dy, CV_32F, 0, 1, 3, 0.125);
  const auto slope = [&](int x, int y) {
    const cv::Vec3f a = dx.at<cv::Vec3f>(y, x), b = dy.at<cv::Vec3f>(y, x);
    return std::sqrt((a.dot(a) + b.dot(b)) / 3);
  };
  std::vector<double> differences;
  const auto measure = [&](int x, int y) {
    const cv::Vec3f d = image.at<cv::Vec3f>(y, x) - plate.at<cv::Vec3f>(y, x);
    if (kShift * slope(x, y) > kLeastSigma) return;
    for (int c = 0; c < 3; ++c) differences.push_back(std::abs(d[c]));
  };
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      if (certain.at<std::uint8_t>(y, x)) measure(x, y);
  const auto noise = std::max(kLeastSigma, float(kMedianToSigma * median(differences)));
  cv::Mat sigma(image.size(), CV_32F);
  for (int y = 0; y < sigma.rows; ++y)
    for (int x = 0; x < sigma.cols; ++x) {
      const cv::Vec3f& p = plate.at<cv::Vec3f>(y, x);
      const float darkness = std::max(0.0f, 1 - (p[0] + p[1] + p[2]) / (3 * kDark));
      sigma.at<float>(y, x) = std::sqrt(noise * noise + std::pow(kShift * slope(x, y), 2.0f) +
                                        std::pow(kDarkSigma * darkness, 2.0f));
    }
  return sigma;
}

/// Share of a pixel's (square-rooted) light that a shadow would leave of the plate's.
cv::Mat shadow_depth(const cv::Mat& image, const cv::Mat& plate) {
  cv::Mat depth(image.size(), CV_32F);
  for (int y = 0; y < depth.rows; ++y)
    for (int x = 0; x < depth.cols; ++x) {
      const cv::Vec3f& p = plate.at<cv::Vec3f>(y, x);
      depth.at<float>(y, x) = p.dot(p) > 0 ? image.at<cv::Vec3f>(y, x).dot(p) / p.dot(p) : 0.0f;
    }
  return depth;
}

/// How much a shadow's depth varies in 5 x 5 pixels: around a pixel, or around the smoothest one
/// that is `edge` pixels away at most.
cv::Mat roughness_of(const cv::Mat& depth, int edge) {
  cv::Mat mean, squares, rough;
  cv::blur(depth, mean, {5, 5});
  cv::blur(depth.mul(depth), squares, {5, 5});
  cv::sqrt(cv::max(squares - mean.mul(mean), 0.0), rough);
  const cv::Size window(2 * edge + 1, 2 * edge + 1);
  if (edge > 0) cv::erode(rough, rough, cv::getStructuringElement(cv::MORPH_RECT, window));
  return rough;
}

}  // namespace

MaskEvidence compare_with_plate(const ColourImage& image, const ColourImage& plate_image) {
  PHOTOHULL_CHECK_OP(image.width, ==, plate_image.width);
  PHOTOHULL_CHECK_OP(image.height, ==, plate_image.height);
  const cv::Mat taken = light_roots(image);
  cv::Mat plate = light_roots(plate_image);
  match_exposure(taken, plate);
  cv::Mat frame(taken.size(), CV_8U, cv::Scalar(0));
  for_each_at_frame(taken.size(), [&](int x, int y) { frame.at<std::uint8_t>(y, x) = 255; });
  return compare_with_expected(taken, plate, frame, 0);
}

MaskEvidence compare_with_expected(const cv::Mat& taken, const cv::Mat& plate,
                                   const cv::Mat& certain, int edge, const cv::Mat& least,
                                   const cv::Mat& shaded) {
  cv::Mat sigma = expected_deviation(taken, plate, certain);
  if (!least.empty()) cv::max(sigma, least, sigma);
  const cv::Mat depth = shadow_depth(taken, plate);
  const cv::Mat roughness = roughness_of(depth, edge);
  MaskEvidence out;
  out.weak = kWeak, out.strong = kStrong;
  out.distance.create(taken.size(), CV_8U);
  double object = 0, sure = 0;
  for (int y = 0; y < taken.rows; ++y)
    for (int x = 0; x < taken.cols; ++x) {
      const cv::Vec3f &p = plate.at<cv::Vec3f>(y, x), &i = taken.at<cv::Vec3f>(y, x);
      const float s = sigma.at<float>(y, x), a = depth.at<float>(y, x);
      double distance = kLevels * std::sqrt((i - p).dot(i - p) / 3) / s;
      const float brightness = std::sqrt(p.dot(p) / 3);
      const bool other = shaded.empty() || !shaded.at<std::uint8_t>(y, x);
      if (other && a < 1 && a > kDarkestShadow && brightness > kLeastPlate) {
        const cv::Vec3f hue = i - a * p;
        const float rough = roughness.at<float>(y, x);
        // Noise alone makes the depth vary by 0.6 deviations over brightness.
        const bool like = kLevels * std::sqrt(hue.dot(hue) / 2) / s < kStrong &&
                          rough * brightness / s < kRoughness;
        if (like) distance = std::min(distance, double(kStrong - 1));
      }
      out.distance.at<std::uint8_t>(y, x) = std::uint8_t(std::min(255.0, std::round(distance)));
      object += distance >= kWeak;
      sure += distance >= kStrong;
    }
  out.doubt = object > 0 ? 1 - sure / object : 0;
  out.unit = sigma / kLevels;
  return out;
}

}  // namespace photohull
