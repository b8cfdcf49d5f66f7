#include "sheet/meet_sheet.h"

#include <cmath>

#include "sheet/bend_sheet.h"

namespace photohull {
namespace {

/// The smallest t beyond 0 where a t^2 + b t + c = 0.
std::optional<double> first_root(double a, double b, double c) {
  if (std::abs(a) * std::abs(c) < 1e-14 * b * b) {
    const double t = -c / b;
    return t > 0 && std::isfinite(t) ? std::optional(t) : std::nullopt;
  }
  const double inside = b * b - 4 * a * c;
  if (!(inside >= 0)) return std::nullopt;
  const double q = -0.5 * (b + std::copysign(std::sqrt(inside), b));
  double low = q / a, high = c / q;
  if (low > high) std::swap(low, high);
  if (low > 0) return low;
  return high > 0 && std::isfinite(high) ? std::optional(high) : std::nullopt;
}

}  // namespace

std::optional<SheetHit> meet_sheet(const glm::dvec3& o, const glm::dvec3& d, const glm::dvec3& bend,
                                   double reach) {
  const double r2 = reach * reach;
  const auto form = [&](double px, double py, double qx, double qy) {
    return (bend.x * px * qx + 0.5 * bend.y * (px * qy + py * qx) + bend.z * py * qy) / r2;
  };
  // That places are drawn in changes their height by less than a thousandth: the form holds for
  // them as they are.
  const auto t = first_root(-form(d.x, d.y, d.x, d.y), d.z - 2 * form(o.x, o.y, d.x, d.y),
                            o.z - form(o.x, o.y, o.x, o.y));
  if (!t) return std::nullopt;
  const glm::dvec3 at = o + *t * d;
  SheetHit hit{*t, glm::dvec2(at), {0, 0, 1}};
  if (bend == glm::dvec3(0.0)) return hit;
  for (int round = 0; round < 3; ++round) {
    glm::dvec3 bent(hit.place, 0);
    bend_sheet(&bend.x, reach, &bent.x);
    hit.place += glm::dvec2(at) - glm::dvec2(bent);
  }
  hit.normal =
      glm::normalize(glm::dvec3(-2 * form(at.x, at.y, 1, 0), -2 * form(at.x, at.y, 0, 1), 1));
  return hit;
}

}  // namespace photohull
