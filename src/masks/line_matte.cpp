#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "masks/photo_lines.h"
#include "masks/photo_pixels.h"

namespace photohull {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kBeside = 2;      // pixels from a line's middle that it can reach
constexpr double kClear = 2;       // pixels from the mask to what is background alone
constexpr int kWindow = 25;        // pixels, of the background around a place
constexpr double kFewest = 20;     // pixels of it
constexpr double kPlain = 0.05;    // of the difference to the object: deviation of the background
constexpr double kDeviations = 3;  // of the background, that a pixel must differ by
constexpr double kStep = 0.5, kReach = 2;  // pixels across a line
constexpr double kFound = 0.5;             // of a line's width

void add_disc(const dvec2& p, cv::Mat& marks) {
  for (int y = std::max(0, int(std::ceil(p.y - kBeside)));
       y <= std::min(marks.rows - 1, int(std::floor(p.y + kBeside))); ++y)
    for (int x = std::max(0, int(std::ceil(p.x - kBeside)));
         x <= std::min(marks.cols - 1, int(std::floor(p.x + kBeside))); ++x)
      if (glm::distance(dvec2(x, y), p) <= kBeside) marks.at<std::uint8_t>(y, x) = 255;
}

/// Mean and deviation of the light around each pixel, of those pixels that are background alone.
class Background {
 public:
  Background(const cv::Mat& linear, const cv::Mat& alone) {
    cv::Mat weight, light, squares;
    alone.convertTo(weight, CV_32F, 1 / 255.0);
    cv::Mat three;
    cv::merge(std::vector<cv::Mat>(3, weight), three);
    light = linear.mul(three), squares = linear.mul(light);
    const auto sum = [](const cv::Mat& from, cv::Mat& to) {
      cv::boxFilter(from, to, CV_32F, {kWindow, kWindow}, {-1, -1}, false, cv::BORDER_CONSTANT);
    };
    sum(weight, count_), sum(light, light_), sum(squares, squares_);
  }

  /// False where too little of it is near.
  bool at(int x, int y, dvec3& mean, double& deviation) const {
    const double count = count_.at<float>(y, x);
    if (count < kFewest) return false;
    const cv::Vec3f l = light_.at<cv::Vec3f>(y, x), s = squares_.at<cv::Vec3f>(y, x);
    mean = dvec3(l[0], l[1], l[2]) / count;
    const dvec3 variance = dvec3(s[0], s[1], s[2]) / count - mean * mean;
    deviation = std::sqrt(std::max(variance.x + variance.y + variance.z, 0.0));
    return true;
  }

 private:
  cv::Mat count_, light_, squares_;
};

/// Share of the object in the pixels of `marks`, where the background is plain.
cv::Mat matte(const Pixels& pixels, const std::vector<dvec3>& palette, const cv::Mat& marks,
              const cv::Mat& alone) {
  cv::Mat share(marks.size(), CV_32F, cv::Scalar(0));
  const Background background(pixels.linear, alone);
  for (int y = 0; y < marks.rows; ++y)
    for (int x = 0; x < marks.cols; ++x) {
      dvec3 mean;
      double deviation;
      if (marks.at<std::uint8_t>(y, x) == 0 || !background.at(x, y, mean, deviation)) continue;
      const cv::Vec3f c = pixels.linear.at<cv::Vec3f>(y, x);
      const dvec3 change = dvec3(c[0], c[1], c[2]) - mean;
      if (glm::length(change) <= kDeviations * deviation) continue;
      const auto part = share_of(palette, change, mean);
      if (!part || deviation * *part > kPlain * glm::length(change)) continue;
      share.at<float>(y, x) = float(std::min(*part, 1.0));
    }
  return share;
}

}  // namespace

void restore_lines(const std::vector<LinePoint>& lines, std::span<const dvec2> places,
                   const SilhouetteDistance& distance, PreparedView& view) {
  PHOTOHULL_CHECK(distance.width == view.image.width && distance.height == view.image.height);
  const Pixels pixels(view.image);
  cv::Mat marks(distance.height, distance.width, CV_8U, cv::Scalar(0));
  for (const LinePoint& p : lines) add_disc({p.x, p.y}, marks);
  for (const dvec2& p : places) add_disc(p, marks);
  const cv::Mat pixels_of_mask(distance.height, distance.width, CV_32F,
                               const_cast<float*>(distance.pixels.data()));
  const cv::Mat alone = (pixels_of_mask > kClear) & (marks == 0);
  const cv::Mat share = matte(pixels, palette_of(pixels, distance), marks, alone);
  for (std::size_t i = 0; i < view.mask.coverage.size(); ++i)
    view.mask.coverage[i] =
        std::max(view.mask.coverage[i], std::uint8_t(std::lround(255 * share.ptr<float>()[i])));
  std::vector<LinePoint> rest;
  for (const LinePoint& p : lines) {
    double found = 0;
    for (double s = -kReach; s <= kReach; s += kStep) {
      const int x = int(std::lround(p.x + s * p.normal_x));
      const int y = int(std::lround(p.y + s * p.normal_y));
      if (x >= 0 && y >= 0 && x < share.cols && y < share.rows)
        found += kStep * share.at<float>(y, x);
    }
    if (found < kFound * p.width) rest.push_back(p);
  }
  draw_lines(rest, view.mask);
}

}  // namespace photohull
