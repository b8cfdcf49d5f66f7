#include "masks/photo_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace photohull {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kSameColour = 0.9;   // cosine between differences of colour
constexpr std::size_t kPalette = 64;  // colours
constexpr double kWellInside = 1.5;   // pixels
constexpr int kUnknownBorder = 5;     // pixels around what was not photographed

}  // namespace

Pixels::Pixels(const ColourImage& image)
    : linear(image.height, image.width, CV_32FC3), root(image.height, image.width, CV_32FC3) {
  std::array<float, 256> table;
  for (std::size_t i = 0; i < 256; ++i) table[i] = float(linear_from_srgb(double(i) / 255));
  if (image.has_alpha) known = cv::Mat(image.height, image.width, CV_8U, cv::Scalar(255));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      cv::Vec3f c;
      float alpha = 1;
      if (image.encoding == ColourImage::Encoding::kSrgb8) {
        const std::uint8_t* p = &image.bytes[(std::size_t(y) * image.width + x) * 4];
        for (int i = 0; i < 3; ++i) c[i] = table[p[i]];
        alpha = p[3];
      } else {
        const glm::vec4 l = image.linear(x, y);
        for (int i = 0; i < 3; ++i) c[i] = std::max(l[i], 0.0f);
        alpha = l.a;
      }
      linear.at<cv::Vec3f>(y, x) = c;
      root.at<cv::Vec3f>(y, x) = {std::sqrt(c[0]), std::sqrt(c[1]), std::sqrt(c[2])};
      if (!known.empty() && alpha == 0) known.at<std::uint8_t>(y, x) = 0;
    }
  if (!known.empty())
    cv::erode(known, known, cv::Mat::ones(2 * kUnknownBorder + 1, 2 * kUnknownBorder + 1, CV_8U));
}

dvec3 Pixels::bilinear(const cv::Mat& from, const dvec2& p) {
  const int x = std::clamp(int(std::floor(p.x)), 0, from.cols - 2);
  const int y = std::clamp(int(std::floor(p.y)), 0, from.rows - 2);
  const double u = std::clamp(p.x - x, 0.0, 1.0), v = std::clamp(p.y - y, 0.0, 1.0);
  const auto at = [&](int i, int j) {
    const cv::Vec3f& c = from.at<cv::Vec3f>(y + j, x + i);
    return dvec3(c[0], c[1], c[2]);
  };
  return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
}

std::vector<dvec3> palette_of(const Pixels& pixels, const SilhouetteDistance& distance) {
  for (const double inside : {kWellInside, 0.5}) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < distance.pixels.size(); ++i)
      if (distance.pixels[i] < -inside) places.push_back(i);
    if (places.size() < kPalette) continue;
    std::vector<dvec3> palette;
    for (std::size_t i = 0; i < kPalette; ++i) {
      const std::size_t at = places[(2 * i + 1) * places.size() / (2 * kPalette)];
      const cv::Vec3f& c = pixels.linear.at<cv::Vec3f>(int(at / std::size_t(distance.width)),
                                                       int(at % std::size_t(distance.width)));
      palette.emplace_back(c[0], c[1], c[2]);
    }
    return palette;
  }
  return {};
}

std::optional<double> share_of(std::span<const dvec3> palette, const dvec3& change,
                               const dvec3& background) {
  std::vector<double> shares;
  for (const dvec3& colour : palette) {
    const dvec3 d = colour - background;
    const double dot = glm::dot(change, d);
    if (dot > kSameColour * glm::length(change) * glm::length(d))
      shares.push_back(dot / glm::dot(d, d));
  }
  if (shares.empty()) return std::nullopt;
  const auto half = shares.begin() + long(shares.size() / 2);
  std::nth_element(shares.begin(), half, shares.end());
  return *half;
}

}  // namespace photohull
