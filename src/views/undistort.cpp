// Inverse mapping: each pixel of the pinhole picture looks up where the lens imaged its ray.
#include "views/undistort.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "core/error.h"

namespace photohull {
namespace {

/// Polynomial 1 + c0 x + c1 x^2 + ...
template <std::size_t n>
double one_plus(const std::array<double, n>& c, double x) {
  double sum = 0;
  for (std::size_t i = n; i-- > 0;) sum = (sum + c[i]) * x;
  return 1 + sum;
}

/// Distorted over ideal distance where ideal = distorted (1 + k1 distorted^2 + k2 distorted^4);
/// zero, which reads as folded, beyond where that grows.
double measured_scale(double k1, double k2, double ideal) {
  double distorted = ideal;
  for (int step = 0; step < 50; ++step) {
    const double squared = distorted * distorted;
    const double slope = 1 + squared * (3 * k1 + 5 * k2 * squared);
    if (!(slope > 1e-3)) return 0;
    const double change = (distorted * (1 + squared * (k1 + k2 * squared)) - ideal) / slope;
    distorted -= change;
    if (std::abs(change) <= 1e-15 * (1 + ideal)) return ideal > 0 ? distorted / ideal : 1;
  }
  return 0;
}

/// Distorted over ideal distance from the axis.
double radial_scale(const Distortion& d, double radius) {
  const auto& k = d.coefficients;
  const double squared = radius * radius;
  if (d.model == DistortionModel::kFisheye) {
    if (radius < 1e-8) return 1;
    const double theta = std::atan(radius), t2 = theta * theta;
    return theta * one_plus<4>({k[0], k[1], k[2], k[3]}, t2) / radius;
  }
  if (d.model == DistortionModel::kPolynomial)
    return one_plus<4>({k[0], k[1], k[4], k[5]}, squared);
  if (d.model == DistortionModel::kMeasured) return measured_scale(k[0], k[1], radius);
  return one_plus<3>({k[0], k[1], k[4]}, squared) / one_plus<3>({k[5], k[6], k[7]}, squared);
}

/// Up to this distance from the axis the distorted distance grows with the ideal one, at most
/// `limit`. Beyond, the model folds back and would show the photograph twice.
double monotonic_radius(const Distortion& d, double limit) {
  constexpr int kSteps = 2000;
  double before = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double radius = limit * i / kSteps;
    const double distorted = radius * radial_scale(d, radius);
    if (!(distorted > before)) return limit * (i - 1) / kSteps;
    before = distorted;
  }
  return limit;
}

glm::dvec2 ideal_point(const Intrinsics& k, double u, double v) {
  const double y = (v - k.cy) / k.fy;
  return {(u - k.cx - k.skew * y) / k.fx, y};
}

/// Rectangle of pixel areas about the principal point, `growth` times as far as the photograph.
struct Extent {
  double left, top, right, bottom;
};

Extent extent(const Intrinsics& k, double growth) {
  return {k.cx - growth * std::max(k.cx + 0.5, 1.0), k.cy - growth * std::max(k.cy + 0.5, 1.0),
          k.cx + growth * std::max(k.width - 0.5 - k.cx, 1.0),
          k.cy + growth * std::max(k.height - 0.5 - k.cy, 1.0)};
}

/// Pixel positions of a photograph, by those of its pinhole picture.
class LensMap {
 public:
  LensMap(const Intrinsics& source, const Distortion& distortion, double max_growth)
      : source_(source), distortion_(distortion) {
    const Extent e = extent(source, max_growth);
    double corner = 0;
    for (const double u : {e.left, e.right})
      for (const double v : {e.top, e.bottom})
        corner = std::max(corner, glm::length(ideal_point(source, u, v)));
    const double radius = monotonic_radius(distortion, corner);
    max_squared_radius_ = radius * radius;
  }

  /// Source position of a ray; false where the photograph does not show it.
  bool look_up(const glm::dvec2& ideal, glm::dvec2& position) const {
    if (glm::dot(ideal, ideal) > max_squared_radius_) return false;
    const glm::dvec2 p = distort(distortion_, ideal);
    position = {source_.fx * p.x + source_.skew * p.y + source_.cx, source_.fy * p.y + source_.cy};
    return position.x >= -0.5 && position.y >= -0.5 && position.x <= source_.width - 0.5 &&
           position.y <= source_.height - 0.5;
  }

 private:
  Intrinsics source_;
  Distortion distortion_;
  double max_squared_radius_ = 0;
};

/// Four taps along one axis, clamped to the picture: cubic convolution with a = -1/2 (Keys, "Cubic
/// convolution interpolation for digital image processing", 1981 [Keys1981]).
struct CubicTaps {
  CubicTaps(double position, int size) {
    const int base = int(position + 1) - 1;  // the floor, as positions are -0.5 at least
    const auto t = float(position - base);
    for (int i = 0; i < 4; ++i) index[i] = std::clamp(base - 1 + i, 0, size - 1);
    weight[0] = t * (-0.5f + t * (1.0f - 0.5f * t));
    weight[1] = 1.0f + t * t * (-2.5f + 1.5f * t);
    weight[2] = t * (0.5f + t * (2.0f - 1.5f * t));
    weight[3] = t * t * (-0.5f + 0.5f * t);
  }
  int index[4];
  float weight[4];
};

const std::array<float, 256>& linear_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < 256; ++i) t[i] = float(linear_from_srgb(double(i) / 255.0));
    return t;
  }();
  return table;
}

/// Fine enough that rounding differs from the exact function by less than 0.06 levels.
const std::vector<std::uint8_t>& srgb_table() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> t(65536);
    for (std::size_t i = 0; i < t.size(); ++i)
      t[i] = std::uint8_t(std::lround(255 * srgb_from_linear(double(i) / 65535.0)));
    return t;
  }();
  return table;
}

/// Opaque 8-bit sRGB pixels as linear light.
struct Srgb8 {
  glm::vec3 load(const std::uint8_t* p) const { return {linear[p[0]], linear[p[1]], linear[p[2]]}; }
  void store(const glm::vec3& colour, std::uint8_t* p) const {
    for (int c = 0; c < 3; ++c)
      p[c] = srgb[std::size_t(std::clamp(colour[c], 0.0f, 1.0f) * 65535.0f + 0.5f)];
    p[3] = 255;
  }

  const float* linear = linear_table().data();
  const std::uint8_t* srgb = srgb_table().data();
};

/// Opaque half-float pixels.
struct LinearHalf {
  glm::vec3 load(const std::uint8_t* p) const {
    std::uint64_t packed;
    std::memcpy(&packed, p, sizeof packed);
    return glm::vec3(glm::unpackHalf4x16(packed));
  }
  void store(const glm::vec3& colour, std::uint8_t* p) const {
    constexpr float kLargestHalf = 65504.0f;
    const std::uint64_t packed =
        glm::packHalf4x16(glm::vec4(glm::clamp(colour, 0.0f, kLargestHalf), 1.0f));
    std::memcpy(p, &packed, sizeof packed);
  }
};

template <typename Format>
void sample_colour(const Format& format, const ColourImage& source, const glm::dvec2& position,
                   std::uint8_t* out) {
  const CubicTaps x(position.x, source.width), y(position.y, source.height);
  const std::size_t size = source.bytes_per_pixel();
  glm::vec3 sum(0.0f);
  for (int j = 0; j < 4; ++j) {
    const std::uint8_t* row = &source.bytes[std::size_t(y.index[j]) * source.width * size];
    glm::vec3 line(0.0f);
    for (int i = 0; i < 4; ++i)
      line += x.weight[i] * format.load(row + std::size_t(x.index[i]) * size);
    sum += y.weight[j] * line;
  }
  format.store(sum, out);
}

std::uint8_t sample_coverage(const Mask& mask, const glm::dvec2& position) {
  const double x = std::clamp(position.x, 0.0, mask.width - 1.0);
  const double y = std::clamp(position.y, 0.0, mask.height - 1.0);
  const int x0 = int(x), y0 = int(y);
  const int x1 = std::min(x0 + 1, mask.width - 1), y1 = std::min(y0 + 1, mask.height - 1);
  const auto at = [&](int i, int j) {
    return double(mask.coverage[std::size_t(j) * mask.width + std::size_t(i)]);
  };
  const double upper = std::lerp(at(x0, y0), at(x1, y0), x - x0);
  const double lower = std::lerp(at(x0, y1), at(x1, y1), x - x0);
  return std::uint8_t(std::lround(std::lerp(upper, lower, y - y0)));
}

/// Replaces the view's image and mask by those of a pinhole camera.
template <typename Format>
void resample(const Format& format, const LensMap& map, const Intrinsics& k, PreparedView& view) {
  const std::size_t size = view.image.bytes_per_pixel();
  const std::size_t pixels = std::size_t(k.width) * k.height;
  ColourImage image{k.width, k.height, view.image.encoding, false, {}};
  image.bytes.assign(pixels * size, 0);
  Mask mask;
  if (!view.mask.empty()) mask = {k.width, k.height, std::vector<std::uint8_t>(pixels, 255)};
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.width; ++u) {
      const std::size_t i = std::size_t(v) * k.width + std::size_t(u);
      glm::dvec2 position;
      if (!map.look_up(ideal_point(k, u, v), position)) {
        image.has_alpha = true;
        continue;
      }
      sample_colour(format, view.image, position, &image.bytes[i * size]);
      if (!mask.empty()) mask.coverage[i] = sample_coverage(view.mask, position);
    }
  view.image = std::move(image);
  view.mask = std::move(mask);
}

/// Is every ray imaged where a pinhole would image it?
bool is_pinhole(const Distortion& d) {
  const auto is_zero = [](double k) { return k == 0; };
  return d.model == DistortionModel::kNone ||
         (d.model != DistortionModel::kFisheye &&
          std::all_of(d.coefficients.begin(), d.coefficients.end(), is_zero));
}

}  // namespace

glm::dvec2 distort(const Distortion& distortion, const glm::dvec2& ideal) {
  if (distortion.model == DistortionModel::kNone) return ideal;
  const double squared = glm::dot(ideal, ideal);
  glm::dvec2 p = radial_scale(distortion, std::sqrt(squared)) * ideal;
  if (distortion.model == DistortionModel::kBrown ||
      distortion.model == DistortionModel::kPolynomial) {
    const double p1 = distortion.coefficients[2], p2 = distortion.coefficients[3];
    const double xy = 2 * ideal.x * ideal.y;
    p.x += p1 * xy + p2 * (squared + 2 * ideal.x * ideal.x);
    p.y += p1 * (squared + 2 * ideal.y * ideal.y) + p2 * xy;
  }
  return p;
}

std::optional<glm::dvec2> undistort_point(const Distortion& distortion,
                                          const glm::dvec2& distorted) {
  constexpr double kStep = 1e-6, kConverged = 1e-12;
  glm::dvec2 ideal = distorted;
  for (int step = 0; step < 50; ++step) {
    const glm::dvec2 error = distort(distortion, ideal) - distorted;
    const glm::dmat2 slope(
        (distort(distortion, ideal + glm::dvec2(kStep, 0)) - distorted - error) / kStep,
        (distort(distortion, ideal + glm::dvec2(0, kStep)) - distorted - error) / kStep);
    if (!(glm::determinant(slope) > 1e-3)) return std::nullopt;
    const glm::dvec2 change = glm::inverse(slope) * error;
    ideal -= change;
    if (glm::length(change) <= kConverged * (1 + glm::length(ideal))) return ideal;
  }
  return std::nullopt;
}

Intrinsics undistorted_intrinsics(const Intrinsics& source, const Distortion& distortion,
                                  double max_growth) {
  constexpr int kSteps =
      256;  // across the largest frame; one step of margin covers what lies between
  const LensMap map(source, distortion, max_growth);
  const Extent e = extent(source, max_growth);
  const double du = (e.right - e.left) / kSteps, dv = (e.bottom - e.top) / kSteps;
  Extent shown{source.cx, source.cy, source.cx, source.cy};
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      const double u = e.left + i * du, v = e.top + j * dv;
      glm::dvec2 position;
      if (!map.look_up(ideal_point(source, u, v), position)) continue;
      shown = {std::min(shown.left, u - du), std::min(shown.top, v - dv),
               std::max(shown.right, u + du), std::max(shown.bottom, v + dv)};
    }
  const int left = int(std::floor(std::max(shown.left, e.left)));
  const int top = int(std::floor(std::max(shown.top, e.top)));
  Intrinsics k = source;
  k.width = std::max(1, int(std::ceil(std::min(shown.right, e.right))) - left + 1);
  k.height = std::max(1, int(std::ceil(std::min(shown.bottom, e.bottom))) - top + 1);
  k.cx -= left;
  k.cy -= top;
  return k;
}

namespace {

/// Resamples a view to a pinhole camera's picture.
void resample_to(const Intrinsics& k, const LensMap& map, PreparedView& view) {
  if (view.image.encoding == ColourImage::Encoding::kSrgb8)
    resample(Srgb8(), map, k, view);
  else
    resample(LinearHalf(), map, k, view);
  view.camera.intrinsics = k;
}

/// The smallest such camera whose frame, centred on the principal point, shows what `source` does.
Intrinsics centred_square(const Intrinsics& source) {
  double right = 0, down = 0;
  for (const double u : {-0.5, source.width - 0.5})
    for (const double v : {-0.5, source.height - 0.5}) {
      const glm::dvec2 p = ideal_point(source, u, v);
      right = std::max(right, std::abs(p.x));
      down = std::max(down, std::abs(p.y));
    }
  Intrinsics k;
  k.fx = k.fy = std::max(source.fx, source.fy);
  // Less than a hundredth of a pixel more is no reason for another column.
  k.width = std::max(1, int(std::ceil(2 * right * k.fx - 0.01)));
  k.height = std::max(1, int(std::ceil(2 * down * k.fy - 0.01)));
  k.cx = 0.5 * (k.width - 1);
  k.cy = 0.5 * (k.height - 1);
  return k;
}

}  // namespace

Intrinsics pinhole_intrinsics(const Intrinsics& source, const Distortion& distortion,
                              double max_growth) {
  return is_pinhole(distortion) ? source : undistorted_intrinsics(source, distortion, max_growth);
}

void undistort(const Distortion& distortion, double max_growth, PreparedView& view) {
  if (is_pinhole(distortion)) return;
  const LensMap map(view.camera.intrinsics, distortion, max_growth);
  resample_to(undistorted_intrinsics(view.camera.intrinsics, distortion, max_growth), map, view);
}

void rectify(const Distortion& distortion, double max_growth, PreparedView& view) {
  Intrinsics source = view.camera.intrinsics;
  const LensMap map(source, distortion, max_growth);
  if (!is_pinhole(distortion)) source = undistorted_intrinsics(source, distortion, max_growth);
  const Intrinsics k = centred_square(source);
  const Intrinsics& before = view.camera.intrinsics;
  const bool same = is_pinhole(distortion) && k.width == before.width &&
                    k.height == before.height && k.fx == before.fx && k.fy == before.fy &&
                    before.skew == 0 && k.cx == before.cx && k.cy == before.cy;
  if (!same) resample_to(k, map, view);
}

}  // namespace photohull
