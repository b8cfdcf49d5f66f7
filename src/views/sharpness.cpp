// Structure tensors [Foerstner87].
#include "views/sharpness.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/median.h"
#include "photo/grey_image.h"

namespace photohull {
namespace {

constexpr double kFine = 0.7, kCoarse = 2.8;  // Gaussians, pixels
constexpr int kBorder = 4;                    // pixels that do not count
constexpr int kFewestPixels = 400;
constexpr double kLeastGradient = 1;  // levels a pixel, of the coarse image where it is weaker
constexpr std::size_t kNeighbours = 8, kFewestNeighbours = 3;
constexpr double kMostFootprint = 1.5;  // between neighbours' pixels
constexpr double kMostAngle = 60;       // degrees: beyond, they show something else
constexpr std::uint8_t kInside = 250;   // coverage

/// Sum over pixels of the gradient's outer product.
struct Tensor {
  double xx = 0, xy = 0, yy = 0;
};

cv::Mat blurred(const GreyImage& grey, double sigma) {
  const cv::Mat pixels(grey.height, grey.width, CV_32F, const_cast<float*>(grey.values.data()));
  cv::Mat out;
  cv::GaussianBlur(pixels, out, {}, sigma);
  return out;
}

/// Variance of the central difference of white noise of variance 1 after the fine Gaussian.
double noise_share() {
  cv::Mat point = cv::Mat::zeros(21, 21, CV_32F), g;
  point.at<float>(10, 10) = 1;
  cv::GaussianBlur(point, g, {}, kFine);
  double sum = 0;
  for (int y = 1; y < 20; ++y)
    for (int x = 1; x < 20; ++x)
      sum += std::pow(0.5 * double(g.at<float>(y, x + 1) - g.at<float>(y, x - 1)), 2);
  return sum;
}

struct Detail {
  double share = 0;    ///< of fine in coarse energy in the direction with the least; 0: no texture
  bool clear = false;  ///< is it more than what noise adds to it?
};

/// The smaller root of det(f - s c) = 0.
double least_share(const Tensor& f, const Tensor& c) {
  const double determinant = c.xx * c.yy - c.xy * c.xy;
  const double b = f.xx * c.yy + f.yy * c.xx - 2 * f.xy * c.xy;
  const double d = std::sqrt(std::max(0.0, b * b - 4 * determinant * (f.xx * f.yy - f.xy * f.xy)));
  return (b - d) / (2 * determinant);
}

Detail detail_of(const PreparedView& view, double noise_variance) {
  const GreyImage grey = grey_image(view.image);
  const cv::Mat fine = blurred(grey, kFine), coarse = blurred(grey, kCoarse);
  Tensor f, c;
  int count = 0;
  const auto add = [](const cv::Mat& m, int x, int y, Tensor& t) {
    const double gx = 0.5 * double(m.at<float>(y, x + 1) - m.at<float>(y, x - 1));
    const double gy = 0.5 * double(m.at<float>(y + 1, x) - m.at<float>(y - 1, x));
    t.xx += gx * gx, t.xy += gx * gy, t.yy += gy * gy;
  };
  for (int y = kBorder; y < grey.height - kBorder; ++y)
    for (int x = kBorder; x < grey.width - kBorder; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(grey.width) + std::size_t(x);
      if (!view.mask.empty() && view.mask.coverage[i] < kInside) continue;
      if (view.image.has_alpha && view.image.linear(x, y).a < 1) continue;
      add(fine, x, y, f), add(coarse, x, y, c);
      ++count;
    }
  if (count < kFewestPixels) return {};
  const double half = 0.5 * (c.xx + c.yy), determinant = c.xx * c.yy - c.xy * c.xy;
  if (half - std::sqrt(std::max(0.0, half * half - determinant)) <
      count * kLeastGradient * kLeastGradient)
    return {};
  const double with_noise = least_share(f, c);
  f.xx -= count * noise_variance, f.yy -= count * noise_variance;
  const double share = std::max(1e-6, least_share(f, c));
  return {share, share >= 0.5 * with_noise};
}

}  // namespace

std::vector<double> relative_sharpness(std::span<const PreparedView> views, const Box& box,
                                       double noise_sigma) {
  const double noise = std::pow(255 * noise_sigma, 2) * noise_share();
  std::vector<Detail> detail(views.size());
  tbb::parallel_for(std::size_t(0), views.size(),
                    [&](std::size_t i) { detail[i] = detail_of(views[i], noise); });
  const glm::dvec3 middle = box.center();
  std::vector<glm::dvec3> ways;
  std::vector<double> footprints;
  for (const PreparedView& view : views) {
    ways.push_back(glm::normalize(view.camera.center() - middle));
    footprints.push_back(view.camera.to_camera(middle).z / view.camera.intrinsics.fx);
  }
  const double least_cosine = std::cos(kMostAngle * M_PI / 180);
  std::vector<double> sharpness(views.size(), 1);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!(detail[i].share > 0)) continue;
    std::vector<std::pair<double, double>> near;  // cosine, falling, and detail
    for (std::size_t j = 0; j < views.size(); ++j) {
      const double ratio = footprints[j] / footprints[i];
      const double cosine = glm::dot(ways[i], ways[j]);
      if (j != i && detail[j].clear && ratio < kMostFootprint && ratio > 1 / kMostFootprint &&
          cosine > least_cosine)
        near.emplace_back(-cosine, detail[j].share);
    }
    if (near.size() < kFewestNeighbours) continue;
    std::sort(near.begin(), near.end());
    if (near.size() > kNeighbours) near.resize(kNeighbours);
    std::vector<double> usual;
    for (const auto& [order, value] : near) usual.push_back(value);
    sharpness[i] = std::sqrt(detail[i].share / median(usual));
  }
  return sharpness;
}

}  // namespace photohull
