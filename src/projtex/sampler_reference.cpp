// After: L. Williams 1983 (mipmaps), F. Crow 1984 (summed-area tables), P. Heckbert 1989
// (elliptical Gaussians), all with pixels as squares of even colour.
#include "projtex/sampler_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace photohull::projtex::reference {
namespace {

using glm::dvec2;
using glm::dvec4;

constexpr double kMostAnisotropy = 16;
constexpr double kLeastWidth = 1.0 / 16;       // pixels, of the transition between two of them
constexpr double kLeastTap = 0.5;              // pixels, along the long axis
constexpr double kFiner = 0.25;                // levels below lambda that err least
constexpr double kRound = 0.25;                // of a tap, that footprints may be longer
constexpr double kGaussianVariance = 1.0 / 6;  // of the square's edge squared
constexpr double kLeastVariance = 4e-4;        // pixels squared
constexpr double kTexelsAcross = 2;            // of a level, along the short axis, at least
constexpr double kReach = 3;                   // standard deviations

dvec4 texel(const LinearImage& image, double x, double y) {
  if (!(x >= 0 && y >= 0 && x < image.width && y < image.height)) return dvec4(0);
  return image.pixels[std::size_t(y) * image.width + std::size_t(x)];
}

/// Bilinear interpolation at a position in level coordinates.
dvec4 between(const LinearImage& image, const dvec2& at) {
  const dvec2 low = glm::floor(at), share = at - low;
  dvec4 sum(0);
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx)
      sum += (dx ? share.x : 1 - share.x) * (dy ? share.y : 1 - share.y) *
             texel(image, low.x + dx, low.y + dy);
  return sum;
}

/// A position in pixels as one in texels of a level.
dvec2 on_level(const dvec2& pixel, int level) { return (pixel + 0.5) / double(1 << level) - 0.5; }

/// Weighted mean of the two levels around `lambda`.
template <typename Sample>
dvec4 between_levels(std::size_t levels, double lambda, const Sample& sample) {
  lambda = std::clamp(lambda, 0.0, double(levels - 1));
  const int fine = std::min(int(lambda), int(levels) - 2);
  return glm::mix(sample(fine), sample(fine + 1), lambda - fine);
}

dvec4 trilinear(std::span<const LinearImage> chain, const dvec2& pixel, double width) {
  return between_levels(chain.size(), std::log2(std::max(width, 1.0)),
                        [&](int level) { return between(chain[level], on_level(pixel, level)); });
}

/// Sides of the upright rectangle with the footprint's second moments.
dvec2 upright(const Footprint& f) {
  return {std::hypot(f.du.x, f.dv.x), std::hypot(f.du.y, f.dv.y)};
}

/// Level (i, j) of the ripmap is the image averaged over 2^i x 2^j pixels.
dvec4 rip_texel(const LinearImage& image, int i, int j, double x, double y) {
  if (x < 0 || y < 0) return dvec4(0);
  dvec4 sum(0);
  const double wide = std::exp2(i), high = std::exp2(j);
  for (double b = 0; b < high; ++b)
    for (double a = 0; a < wide; ++a) sum += texel(image, x * wide + a, y * high + b);
  return sum / (wide * high);
}

dvec4 ripmap(const LinearImage& image, const Footprint& f) {
  const dvec2 sides = upright(f);
  const double lx = std::clamp(std::log2(sides.x), 0.0, kSampleLevels - 1.0);
  const double ly = std::clamp(std::log2(sides.y), 0.0, kSampleLevels - 1.0);
  const int i0 = int(lx), j0 = int(ly);
  dvec4 sum(0);
  for (int j = j0; j <= std::min(j0 + 1, kSampleLevels - 1); ++j)
    for (int i = i0; i <= std::min(i0 + 1, kSampleLevels - 1); ++i) {
      const double share =
          (i == i0 ? 1 - (lx - i0) : lx - i0) * (j == j0 ? 1 - (ly - j0) : ly - j0);
      const dvec2 at{on_level(f.pixel, i).x, on_level(f.pixel, j).y}, low = glm::floor(at);
      for (int b = 0; b < 2; ++b)
        for (int a = 0; a < 2; ++a)
          sum += share * (1 - std::abs(low.x + a - at.x)) * (1 - std::abs(low.y + b - at.y)) *
                 rip_texel(image, i, j, low.x + a, low.y + b);
    }
  return sum;
}

dvec4 summed_area(const LinearImage& image, const Footprint& f) {
  const dvec2 half = 0.5 * glm::clamp(upright(f), dvec2(kLeastWidth), dvec2(kPadding * 2));
  const std::array<dvec2, 4> box{f.pixel - half, dvec2(f.pixel.x + half.x, f.pixel.y - half.y),
                                 f.pixel + half, dvec2(f.pixel.x - half.x, f.pixel.y + half.y)};
  return integrate_polygon(image, box);
}

dvec4 anisotropic(std::span<const LinearImage> chain, const Footprint& f) {
  const FootprintAxes axes = axes_of(f);
  const double ratio = axes.longer / std::max(axes.shorter, kLeastTap);
  const double taps = std::clamp(std::ceil(ratio - kRound), 1.0, kMostAnisotropy);
  const double spacing = axes.longer / taps;
  const dvec2 along = axes.direction, across(-along.y, along.x);
  const double widest = std::max(axes.shorter, spacing);
  dvec4 sum(0);
  for (double k = 0; k < taps; ++k) {
    dvec2 at = f.pixel + along * (spacing * (k + 0.5 - 0.5 * taps));
    // Between two pixels, the place that stands for a box around `at` of the tap's own size.
    for (int i = 0; i < 2; ++i) {
      const double width = std::hypot(spacing * along[i], axes.shorter * across[i]);
      const double low = std::floor(at[i]), transition = std::clamp(width, kLeastWidth, 1.0);
      at[i] = low + std::clamp((at[i] - low - 0.5) / transition + 0.5, 0.0, 1.0);
    }
    sum += trilinear(chain, at, widest * std::exp2(-kFiner));
  }
  return sum / taps;
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }
double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi); }

/// Elliptical Gaussian with the mean of each pixel's square: row by row, the Gaussian's share of
/// the row, spread along it as the Gaussian is that fits the row best.
dvec4 ewa(std::span<const LinearImage> chain, const Footprint& f) {
  const FootprintAxes axes = axes_of(f);
  double longer = axes.longer, shorter = std::max(axes.shorter, longer / kMostAnisotropy);
  const int level = std::clamp(int(std::floor(std::log2(std::max(shorter, 1e-6) / kTexelsAcross))),
                               0, int(chain.size()) - 1);
  const LinearImage& image = chain[level];
  const double size = 1 << level;
  shorter = std::min(shorter, 2 * kTexelsAcross * size) / size;
  longer = std::min(longer, 2 * kTexelsAcross * kMostAnisotropy * size) / size;
  const dvec2 e = axes.direction;
  const double l = kGaussianVariance * longer * longer, s = kGaussianVariance * shorter * shorter;
  const double xx = l * e.x * e.x + s * e.y * e.y + kLeastVariance;
  const double yy = l * e.y * e.y + s * e.x * e.x + kLeastVariance;
  const double xy = (l - s) * e.x * e.y, slope = xy / yy, rest = xx - slope * xy;
  const dvec2 at = on_level(f.pixel, level);
  const double deviation = std::sqrt(yy);
  dvec4 sum(0);
  double weights = 0;
  for (double y = std::ceil(at.y - kReach * deviation - 0.5); y <= at.y + kReach * deviation + 0.5;
       ++y) {
    const double z0 = (y - 0.5 - at.y) / deviation, z1 = (y + 0.5 - at.y) / deviation;
    const double row = normal_cdf(z1) - normal_cdf(z0);
    if (row < 1e-4) continue;
    const double middle =
        at.x + slope * deviation * (normal_density(z0) - normal_density(z1)) / row;
    const double spread = std::sqrt(rest + slope * slope * yy / (1 + 12 * yy));
    for (double x = std::ceil(middle - kReach * spread - 0.5); x <= middle + kReach * spread + 0.5;
         ++x) {
      const double weight =
          row * (normal_cdf((x + 0.5 - middle) / spread) - normal_cdf((x - 0.5 - middle) / spread));
      sum += weight * texel(image, x, y);
      weights += weight;
    }
  }
  return sum / weights;
}

/// The part of a convex polygon on one side of an upright line: sign * (p[axis] - bound) <= 0.
std::vector<dvec2> clipped(const std::vector<dvec2>& polygon, int axis, double bound, double sign) {
  std::vector<dvec2> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - bound), db = sign * (b[axis] - bound);
    if (da <= 0) out.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  return out;
}

double area_of(std::span<const dvec2> polygon) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const dvec2 a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    sum += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(sum);
}

}  // namespace

LinearImage covered_image(const ColourImage& image, const Mask& mask,
                          const glm::ivec2& array_size) {
  LinearImage out{array_size.x, array_size.y, {}};
  out.pixels.assign(std::size_t(out.width) * out.height, dvec4(0));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const dvec4 colour = image.linear(x, y);
      const double object =
          mask.empty() ? 1.0 : mask.coverage[std::size_t(y) * mask.width + x] / 255.0;
      out.pixels[std::size_t(y) * out.width + x] =
          dvec4(glm::dvec3(colour), 1.0) * (colour.a * object);
    }
  return out;
}

std::vector<LinearImage> covered_chain(LinearImage image) {
  std::vector<LinearImage> chain{std::move(image)};
  while (int(chain.size()) < kSampleLevels) {
    const LinearImage& fine = chain.back();
    LinearImage level{fine.width / 2, fine.height / 2, {}};
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x)
        level.pixels.push_back(0.25 *
                               (texel(fine, 2 * x, 2 * y) + texel(fine, 2 * x + 1, 2 * y) +
                                texel(fine, 2 * x, 2 * y + 1) + texel(fine, 2 * x + 1, 2 * y + 1)));
    chain.push_back(std::move(level));
  }
  return chain;
}

Footprint footprint_of(const GridCamera& camera, const PlaneSquare& square) {
  const glm::dvec3 at = camera.projection * dvec4(square.centre, 1);
  Footprint f;
  f.in_front = at.z > 0;
  if (!f.in_front) return f;
  f.pixel = dvec2(at) / at.z;
  // Quotient rule on s / q and t / q.
  const auto along = [&](const glm::dvec3& edge) {
    const glm::dvec3 by = camera.projection * dvec4(edge, 0);
    return (dvec2(by) * at.z - dvec2(at) * by.z) / (at.z * at.z);
  };
  f.du = along(square.u);
  f.dv = along(square.v);
  return f;
}

FootprintAxes axes_of(const Footprint& f) {
  // The one-sided rotation that makes the Jacobian's columns orthogonal.
  const double angle =
      0.5 * std::atan2(2 * glm::dot(f.du, f.dv), glm::dot(f.du, f.du) - glm::dot(f.dv, f.dv));
  const dvec2 first = std::cos(angle) * f.du + std::sin(angle) * f.dv;
  const dvec2 second = std::cos(angle) * f.dv - std::sin(angle) * f.du;
  FootprintAxes axes{glm::length(first), glm::length(second), {1, 0}};
  if (axes.longer > 0) axes.direction = first / axes.longer;
  return axes;
}

dvec4 sample_footprint(Sampler sampler, std::span<const LinearImage> chain, const Footprint& f) {
  if (!f.in_front) return dvec4(0);
  switch (sampler) {
    case Sampler::kCentroid:
    case Sampler::kNearest:
      return texel(chain[0], std::floor(f.pixel.x + 0.5), std::floor(f.pixel.y + 0.5));
    case Sampler::kBilinear:
      return between(chain[0], f.pixel);
    case Sampler::kTrilinear:
      return trilinear(chain, f.pixel, std::max(glm::length(f.du), glm::length(f.dv)));
    case Sampler::kTrilinearDerivative:
      return trilinear(
          chain, f.pixel,
          std::max({std::abs(f.du.x), std::abs(f.du.y), std::abs(f.dv.x), std::abs(f.dv.y)}));
    case Sampler::kRipmap:
      return ripmap(chain[0], f);
    case Sampler::kSummedArea:
      return summed_area(chain[0], f);
    case Sampler::kAnisotropic:
      return anisotropic(chain, f);
    case Sampler::kEwa:
      return ewa(chain, f);
    case Sampler::kMipmap: {
      const double edge = std::max({glm::length(f.du), glm::length(f.dv), 1.0});
      const int level = std::min(int(std::lround(std::log2(edge))), int(chain.size()) - 1);
      return between(chain[std::size_t(level)], on_level(f.pixel, level));
    }
    case Sampler::kHardware:
      break;
  }
  check_failed(__FILE__, __LINE__, "this sampler has no reference here");
}

dvec4 sample_square(Sampler sampler, std::span<const LinearImage> chain, const GridCamera& camera,
                    const PlaneSquare& square, int supersample) {
  dvec4 sum(0);
  for (int b = 0; b < supersample; ++b)
    for (int a = 0; a < supersample; ++a) {
      const double along_u = (a + 0.5) / supersample - 0.5, along_v = (b + 0.5) / supersample - 0.5;
      const PlaneSquare part{square.centre + along_u * square.u + along_v * square.v,
                             square.u / double(supersample), square.v / double(supersample)};
      sum += sample_footprint(sampler, chain, footprint_of(camera, part));
    }
  return sum / double(supersample * supersample);
}

dvec4 resolved(const dvec4& covered) {
  if (!(covered.a > 0)) return dvec4(0);
  return {glm::sqrt(glm::max(glm::dvec3(covered) / covered.a, glm::dvec3(0))), covered.a};
}

dvec4 integrate_polygon(const LinearImage& image, std::span<const dvec2> corners) {
  PHOTOHULL_CHECK(!corners.empty());
  const std::vector<dvec2> polygon(corners.begin(), corners.end());
  const double area = area_of(polygon);
  if (!(area > 0))
    return texel(image, std::floor(polygon[0].x + 0.5), std::floor(polygon[0].y + 0.5));
  double low = polygon[0].y, high = polygon[0].y;
  for (const dvec2& p : polygon) {
    low = std::min(low, p.y);
    high = std::max(high, p.y);
  }
  low = std::max(std::floor(low + 0.5), 0.0);
  high = std::min(std::floor(high + 0.5), image.height - 1.0);
  dvec4 sum(0);
  for (double y = low; y <= high; ++y) {
    const auto row = clipped(clipped(polygon, 1, y + 0.5, 1), 1, y - 0.5, -1);
    if (row.empty()) continue;
    const auto [left, right] = std::minmax_element(
        row.begin(), row.end(), [](const dvec2& a, const dvec2& b) { return a.x < b.x; });
    const double first = std::max(std::floor(left->x + 0.5), 0.0);
    const double last = std::min(std::floor(right->x + 0.5), image.width - 1.0);
    for (double x = first; x <= last; ++x) {
      const auto piece = clipped(clipped(row, 0, x + 0.5, 1), 0, x - 0.5, -1);
      sum += area_of(piece) * texel(image, x, y);
    }
  }
  return sum / area;
}

dvec4 oracle(const LinearImage& image, const GridCamera& camera, const PlaneSquare& square) {
  std::array<dvec2, 4> corners;
  for (int i = 0; i < 4; ++i) {
    const double a = i == 1 || i == 2 ? 0.5 : -0.5, b = i >= 2 ? 0.5 : -0.5;
    const glm::dvec3 p = camera.projection * dvec4(square.centre + a * square.u + b * square.v, 1);
    if (!(p.z > 0)) return dvec4(0);
    corners[i] = dvec2(p) / p.z;
  }
  return integrate_polygon(image, corners);
}

}  // namespace photohull::projtex::reference
