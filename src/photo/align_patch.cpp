#include "photo/align_patch.h"

#include <Eigen/Dense>
#include <cmath>

namespace photohull {
namespace {

/// Does the image hold the patch, which is a parallelogram, and a pixel around?
bool holds_patch(const GreyImage& image, const PatchPlace& place, double radius) {
  for (const double y : {-radius, radius})
    for (const double x : {-radius, radius}) {
      const glm::dvec2 corner = place.center + place.shape * glm::dvec2(x, y);
      if (!image.holds(corner.x - 1, corner.y - 1) || !image.holds(corner.x + 1, corner.y + 1))
        return false;
    }
  return true;
}

/// Bilinear brightness at a place that is held with a pixel around, and its central differences.
struct Sample {
  double value, dx, dy;
};

/// What five calls of GreyImage::at give, to the last bit, but where a coordinate passes a power of
/// two from one pixel to the next.
Sample sample(const GreyImage& image, const glm::dvec2& place) {
  const int i = int(place.x), j = int(place.y), width = image.width;
  const double u = place.x - i, v = place.y - j;
  const float* p = &image.values[std::size_t(j) * width + i];
  const auto across = [u](const float* q) { return (1 - u) * q[0] + u * q[1]; };
  const auto down = [v](double upper, double lower) { return (1 - v) * upper + v * lower; };
  const double row = across(p), next = across(p + width);
  return {down(row, next),
          0.5 * (down(across(p + 1), across(p + width + 1)) -
                 down(across(p - 1), across(p + width - 1))),
          0.5 * (down(next, across(p + 2 * width)) - down(across(p - width), row))};
}

}  // namespace

std::optional<AlignedPatch> align_patch(const GreyImage& image, const glm::dvec2& source,
                                        const GreyImage& other, const PatchPlace& start, int radius,
                                        double farthest, double least_gradient) {
  constexpr int kSteps = 15;
  constexpr double kConverged = 0.003;  // pixels
  using Vector = Eigen::Matrix<double, 8, 1>;
  PatchPlace place = start;
  double gain = 1, offset = 0, agreement = 0;
  bool converged = false;
  const double r = radius;
  if (!image.holds(source.x - r, source.y - r) || !image.holds(source.x + r, source.y + r))
    return std::nullopt;
  std::vector<double> values;  // of the source's pixels, row by row
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) values.push_back(image.at(source.x + x, source.y + y));
  // Of each pixel the derivatives by center, shape, gain and offset.
  Eigen::Matrix<double, 8, Eigen::Dynamic> jacobian(8, values.size());
  for (int step = 0; step <= kSteps && !converged; ++step) {
    if (!holds_patch(other, place, r)) return std::nullopt;
    Vector right = Vector::Zero();
    Eigen::Index i = 0;
    double n = 0, s = 0, t = 0, ss = 0, tt = 0, st = 0;
    for (int y = -radius; y <= radius; ++y)
      for (int x = -radius; x <= radius; ++x, ++i) {
        const auto [b, bx, by] = sample(other, place.center + place.shape * glm::dvec2(x, y));
        const double a = values[std::size_t(i)];
        jacobian.col(i) << bx, by, bx * x, bx * y, by * x, by * y, -a, -1.0;
        right += jacobian.col(i) * (gain * a + offset - b);
        n += 1, s += a, t += b, ss += a * a, tt += b * b, st += a * b;
      }
    const Eigen::Matrix<double, 8, 8> normal = jacobian * jacobian.transpose();
    const double variance = (n * ss - s * s) * (n * tt - t * t);
    agreement = variance > 0 ? (n * st - s * t) / std::sqrt(variance) : 0;
    // The weaker of the gradient's two directions must stand out of 8-bit rounding.
    const double trace = normal(0, 0) + normal(1, 1);
    const double determinant = normal(0, 0) * normal(1, 1) - normal(1, 0) * normal(1, 0);
    const double weaker = 0.5 * (trace - std::sqrt(std::max(0.0, trace * trace - 4 * determinant)));
    if (!(weaker > n * least_gradient * least_gradient)) return std::nullopt;
    const Eigen::LDLT<Eigen::Matrix<double, 8, 8>> solver(normal);
    if (solver.info() != Eigen::Success) return std::nullopt;
    const Vector d = solver.solve(right);
    if (!d.allFinite()) return std::nullopt;
    place.center += glm::dvec2(d[0], d[1]);
    place.shape += glm::dmat2(d[2], d[4], d[3], d[5]);
    gain += d[6], offset += d[7];
    if (glm::distance(place.center, start.center) > farthest) return std::nullopt;
    converged = std::hypot(d[0], d[1]) < kConverged;
  }
  const double area = glm::determinant(place.shape) / glm::determinant(start.shape);
  if (!converged || !(area > 0.5 && area < 2)) return std::nullopt;
  return AlignedPatch{place, agreement};
}

}  // namespace photohull
