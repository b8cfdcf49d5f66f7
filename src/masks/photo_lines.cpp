// Based on: C. Steger, "An unbiased detector of curvilinear structures", PAMI 1998, for images of
// several channels: the line runs across the direction in which all channels together bend most.
#include "masks/photo_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/error.h"
#include "masks/line_chains.h"
#include "masks/photo_pixels.h"
#include "masks/silhouette.h"
#include "photo/noise.h"

namespace photohull {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kRadius = 4;  // pixels that the Gaussian of deviation 1 reaches
constexpr int kBand = 128;  // rows that are differentiated at once
// Of a line's smoothed profile: the Gaussian's, and that of a pixel's area.
constexpr double kProfileVariance = 1 + 1.0 / 12;
constexpr double kWithin = 0.55;  // pixels: a line's point belongs to the pixel that holds it
constexpr double kSigmas = 5;     // of the noise, that a line must bend by
// Deviation of a second derivative of the smoothed image, in those of a pixel's channel; and of a
// channel in those of the luminance, which averages three.
constexpr double kBendNoise = 0.244, kChannelNoise = 1.5;
constexpr double kStep = 0.5;                       // pixels, of the profile across a line
constexpr double kNearestSide = 1.5, kReach = 4.5;  // pixels to the background beside a line
constexpr double kClear = 0.5;              // pixels from the mask: its own edge is no background
constexpr double kAlike = 0.5;              // of a line's contrast: difference of its two sides
constexpr double kPlateau = 0.3;            // of the contrast: what belongs to the side
constexpr double kNarrowest = 0.1;          // pixels
constexpr double kUnknownWidth = 1;         // pixels, where the object shows no such colour
constexpr std::uint32_t kFewestPoints = 6;  // of a line
constexpr double kTouching = 1.5;           // pixels between a mask and a line that continues it
constexpr double kHalfLength = 0.75;        // pixels that a point stands for along its line

/// First and second derivatives of smoothed pixels, rows `first` and on.
struct Derivatives {
  cv::Mat x, y, xx, xy, yy;  ///< CV_32FC3

  Derivatives(const cv::Mat& root, int first, int end) {
    std::array<cv::Mat, 3> k;  // a Gaussian of deviation 1 pixel and its derivatives
    for (cv::Mat& m : k) m = cv::Mat(2 * kRadius + 1, 1, CV_64F);
    for (int i = -kRadius; i <= kRadius; ++i) {
      const double g = std::exp(-0.5 * i * i) / std::sqrt(2 * std::numbers::pi);
      k[0].at<double>(i + kRadius) = g;
      k[1].at<double>(i + kRadius) = i * g;  // filters correlate
      k[2].at<double>(i + kRadius) = (i * i - 1) * g;
    }
    k[2] -= cv::mean(k[2])[0];  // cut off, it must still leave a constant flat
    const cv::Mat rows = root.rowRange(first, end);
    const auto filter = [&](int across, int down, cv::Mat& out) {
      cv::sepFilter2D(rows, out, CV_32F, k[std::size_t(across)], k[std::size_t(down)], {-1, -1}, 0,
                      cv::BORDER_REPLICATE);
    };
    filter(1, 0, x), filter(0, 1, y), filter(2, 0, xx), filter(1, 1, xy), filter(0, 2, yy);
  }
};

/// Pixels to the middle of a line from Newton's step to it, which goes too far (mask_lines.cpp).
double to_middle(double step) {
  const double s = kProfileVariance;
  return step == 0 ? 0 : (std::sqrt(s * s + 4 * step * step * s) - s) / (2 * step);
}

/// A line's place, and the direction in colours in which it is a valley.
struct Ridge {
  dvec2 at, normal;
  dvec3 colour;
};

std::optional<Ridge> locate(const Derivatives& d, int row, int x, int y, double least_bend) {
  const auto value = [&](const cv::Mat& m) {
    const cv::Vec3f& c = m.at<cv::Vec3f>(row, x);
    return dvec3(c[0], c[1], c[2]);
  };
  const dvec3 xx = value(d.xx), xy = value(d.xy), yy = value(d.yy);
  // The sum of the channels' squared matrices of second derivatives.
  const double a = glm::dot(xx, xx) + glm::dot(xy, xy), c = glm::dot(yy, yy) + glm::dot(xy, xy);
  if (a + c < least_bend * least_bend) return std::nullopt;
  const double b = glm::dot(xy, xx + yy);
  const double angle = 0.5 * std::atan2(2 * b, a - c);
  const dvec2 n(std::cos(angle), std::sin(angle));
  const dvec3 bend = n.x * n.x * xx + 2 * n.x * n.y * xy + n.y * n.y * yy;
  const double strength = glm::length(bend);
  if (!(strength >= least_bend)) return std::nullopt;
  const dvec3 along = n.y * n.y * xx - 2 * n.x * n.y * xy + n.x * n.x * yy;
  const dvec3 colour = bend / strength;
  if (std::abs(glm::dot(along, colour)) > 0.5 * strength) return std::nullopt;  // a speck
  const double slope = glm::dot(colour, n.x * value(d.x) + n.y * value(d.y));
  const double offset = to_middle(-slope / strength);
  if (std::abs(offset * n.x) > kWithin || std::abs(offset * n.y) > kWithin) return std::nullopt;
  return Ridge{dvec2(x, y) + offset * n, n, colour};
}

class Measure {
 public:
  Measure(const Pixels& pixels, const SilhouetteDistance& distance, double widest, double noise)
      : pixels_(pixels),
        distance_(distance),
        palette_(palette_of(pixels, distance)),
        widest_(widest),
        noise_(noise) {}

  /// Nothing where the background differs from one side to the other, or the line is too wide or
  /// too narrow.
  std::optional<LinePoint> measure(const Ridge& ridge) const {
    const double middle = valley(ridge, 0);
    const auto one = side(ridge, 1), other = side(ridge, -1);
    if (!one || !other) return std::nullopt;
    const double contrast = 0.5 * (one->level + other->level) - middle;
    if (!(contrast > kSigmas * noise_)) return std::nullopt;
    if (std::abs(one->level - other->level) > kAlike * contrast) return std::nullopt;
    const dvec3 right = colour(ridge, *one, 1, contrast),
                left = colour(ridge, *other, -1, contrast);
    dvec3 total(0);
    for (double s = -other->reach; s <= one->reach; s += kStep) {
      const double t = (s + other->reach) / (one->reach + other->reach);
      total += kStep * (Pixels::bilinear(pixels_.linear, ridge.at + s * ridge.normal) -
                        glm::mix(left, right, t));
    }
    const double width = std::max(width_of(total, 0.5 * (left + right)), kNarrowest);
    if (width > widest_) return std::nullopt;
    return LinePoint{float(ridge.at.x), float(ridge.at.y), float(ridge.normal.x),
                     float(ridge.normal.y), float(width)};
  }

 private:
  /// Where the background beside a line begins.
  struct Side {
    double level = 0, reach = 0;  ///< of the valley, and pixels from the middle
    double end = 0;               ///< pixels, as far as there is background
  };

  double valley(const Ridge& ridge, double s) const {
    return glm::dot(ridge.colour, Pixels::bilinear(pixels_.root, ridge.at + s * ridge.normal));
  }

  bool is_background(const dvec2& p) const {
    const int x = int(std::lround(p.x)), y = int(std::lround(p.y));
    return x >= 0 && y >= 0 && x < distance_.width && y < distance_.height &&
           distance_.pixels[std::size_t(y) * std::size_t(distance_.width) + std::size_t(x)] >
               kClear;
  }

  std::optional<Side> side(const Ridge& ridge, double sign) const {
    std::optional<Side> best;
    double end = 0;
    for (double r = 1; r <= kReach; r += kStep) {
      if (!is_background(ridge.at + sign * r * ridge.normal)) break;
      end = r;
      if (r < kNearestSide) continue;
      const double level = valley(ridge, sign * r);
      if (!best || level > best->level) best = Side{level, r, 0};
    }
    if (best) best->end = end;
    return best;
  }

  /// The mean colour of a side, linear light.
  dvec3 colour(const Ridge& ridge, const Side& side, double sign, double contrast) const {
    dvec3 sum(0);
    double count = 0;
    for (double r = kNearestSide; r <= side.end; r += kStep) {
      if (valley(ridge, sign * r) < side.level - kPlateau * contrast) continue;
      sum += Pixels::bilinear(pixels_.linear, ridge.at + sign * r * ridge.normal), count += 1;
    }
    return sum / count;
  }

  double width_of(const dvec3& total, const dvec3& background) const {
    return share_of(palette_, total, background).value_or(kUnknownWidth);
  }

  const Pixels& pixels_;
  const SilhouetteDistance& distance_;
  std::vector<dvec3> palette_;
  double widest_, noise_;
};

double overlap(double a, double b, double half) {
  return std::clamp(std::min(b, half) - std::max(a, -half), 0.0, 1.0);
}

}  // namespace

std::vector<LinePoint> find_photo_lines(const PreparedView& view,
                                        const SilhouetteDistance& distance,
                                        const PhotoLineOptions& options) {
  PHOTOHULL_CHECK(!view.mask.empty());
  PHOTOHULL_CHECK(distance.width == view.image.width && distance.height == view.image.height);
  std::vector<LinePoint> points;
  const int width = view.image.width, height = view.image.height;
  if (width < 3 || height < 3) return points;
  const Pixels pixels(view.image);
  const double noise = kChannelNoise * std::max(options.noise_sigma, kRoundingNoise);
  const double least_bend = kSigmas * kBendNoise * noise * std::numbers::sqrt3;
  const Measure measure(pixels, distance, options.widest, noise);
  for (int first = 0; first < height; first += kBand) {
    const int end = std::min(first + kBand, height);
    const Derivatives d(pixels.root, first, end);
    for (int y = first; y < end; ++y)
      for (int x = 0; x < width; ++x) {
        if (!(distance.pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)] > 0)) continue;
        if (!pixels.known.empty() && pixels.known.at<std::uint8_t>(y, x) == 0) continue;
        const auto ridge = locate(d, y - first, x, y, least_bend);
        if (!ridge) continue;
        if (const auto point = measure.measure(*ridge)) points.push_back(*point);
      }
  }
  // Short lines count where they continue the mask.
  const std::vector<std::uint32_t> line = lines_of(points);
  std::vector<std::uint32_t> count(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ++count[line[i]];
    if (interpolated(distance, {points[i].x, points[i].y}) < kTouching)
      count[line[i]] += kFewestPoints;
  }
  std::vector<LinePoint> lines;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (count[line[i]] >= kFewestPoints) lines.push_back(points[i]);
  return lines;
}

void draw_lines(const std::vector<LinePoint>& lines, Mask& mask) {
  for (const LinePoint& p : lines) {
    const double half = 0.5 * p.width, reach = half + 0.5 + kHalfLength;
    for (int y = std::max(0, int(std::ceil(p.y - reach)));
         y <= std::min(mask.height - 1, int(std::floor(p.y + reach))); ++y)
      for (int x = std::max(0, int(std::ceil(p.x - reach)));
           x <= std::min(mask.width - 1, int(std::floor(p.x + reach))); ++x) {
        const double dx = x - p.x, dy = y - p.y;
        const double across = dx * p.normal_x + dy * p.normal_y;
        const double along = dy * p.normal_x - dx * p.normal_y;
        const double share = overlap(across - 0.5, across + 0.5, half) *
                             std::clamp(0.5 + kHalfLength - std::abs(along), 0.0, 1.0);
        std::uint8_t& value = mask.coverage[std::size_t(y) * std::size_t(mask.width) + x];
        value = std::max(value, std::uint8_t(std::lround(255 * share)));
      }
  }
}

}  // namespace photohull
