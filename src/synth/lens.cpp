#include "synth/lens.h"

#include <cmath>

namespace photohull::synth {
namespace {

struct Mapped {
  glm::dvec2 position;
  glm::dmat2 derivative;  ///< symmetric
};

Mapped distort(const Distortion& lens, const glm::dvec2& q) {
  if (lens.model == DistortionModel::kNone) return {q, glm::dmat2(1)};
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = lens.coefficients;
  const double x = q.x, y = q.y, r2 = dot(q, q);
  const double radial = 1 + r2 * (k1 + r2 * k2), slope = 2 * (k1 + 2 * r2 * k2);
  Mapped m;
  m.position = {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  const double xx = radial + x * x * slope + 2 * p1 * y + 6 * p2 * x;
  const double yy = radial + y * y * slope + 6 * p1 * y + 2 * p2 * x;
  const double xy = x * y * slope + 2 * p1 * x + 2 * p2 * y;
  m.derivative = glm::dmat2(xx, xy, xy, yy);
  return m;
}

}  // namespace

std::optional<glm::dvec2> LensCamera::project(const glm::dvec3& world) const {
  const glm::dvec3 p = camera.to_camera(world);
  if (!(p.z > 0)) return std::nullopt;
  const glm::dvec2 q = distort(distortion, glm::dvec2(p) / p.z).position;
  const Intrinsics& k = camera.intrinsics;
  return glm::dvec2(k.fx * q.x + k.skew * q.y + k.cx, k.fy * q.y + k.cy);
}

std::optional<glm::dvec2> LensCamera::undistorted(const glm::dvec2& pixel) const {
  const Intrinsics& k = camera.intrinsics;
  const double y = (pixel.y - k.cy) / k.fy;
  const glm::dvec2 target((pixel.x - k.cx - k.skew * y) / k.fx, y);
  if (distortion.model == DistortionModel::kNone) return target;
  glm::dvec2 q = target;
  for (int round = 0; round < 50; ++round) {
    const Mapped m = distort(distortion, q);
    const double det = determinant(m.derivative);
    if (!(det > 0.01)) return std::nullopt;
    const glm::dvec2 step = inverse(m.derivative) * (m.position - target);
    q -= step;
    if (!(dot(step, step) < 1e12)) return std::nullopt;
    if (dot(step, step) < 1e-26) return q;
  }
  return std::nullopt;
}

}  // namespace photohull::synth
