#include "visibility/warp.h"

#include <algorithm>
#include <cmath>

namespace photohull::visibility {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

constexpr double kLeastAxis = 1e-3;   // length of the axis on the map, of the region's extent
constexpr double kMostOpening = 1.5;  // tangent of half the trapezoid's opening
constexpr double kWeakWarp = 1e3;     // n' in lengths of the region that counts as no warp

struct Range {
  double low = 1e300, high = -1e300;
  void add(double x) { low = std::min(low, x), high = std::max(high, x); }
  double size() const { return std::max(high - low, 1e-9); }
};

/// From [range] to [margin, size - margin], as a scale and a shift.
dvec2 onto(const Range& range, double size, double margin) {
  const double scale = std::max(size - 2 * margin, 0.5 * size) / range.size();
  const double used = scale * range.size();
  return {scale, 0.5 * (size - used) - scale * range.low};
}

/// Rows to glm's columns.
dmat3 of_rows(const dvec3& x, const dvec3& y, const dvec3& w) {
  return glm::transpose(dmat3(x, y, w));
}

}  // namespace

WarpMatrix fit_region(const WarpRegion& region, const glm::ivec2& size, double margin) {
  Range x, y;
  for (const dvec2& p : region.texels) x.add(p.x), y.add(p.y);
  const dvec2 fx = onto(x, size.x, margin), fy = onto(y, size.y, margin);
  return of_rows({fx.x, 0, fx.y}, {0, fy.x, fy.y}, {0, 0, 1});
}

WarpMatrix warp_region(const WarpRegion& region, const glm::ivec2& size, double margin, Warp warp,
                       bool& warped) {
  warped = false;
  const dvec2 axis = region.far_end - region.near_end;
  Range x, y;
  for (const dvec2& p : region.texels) x.add(p.x), y.add(p.y);
  if (region.sine <= 0 || glm::length(axis) < kLeastAxis * (x.size() + y.size()))
    return fit_region(region, size, margin);
  const dvec2 along = glm::normalize(axis), across(-along.y, along.x);
  Range length;
  Range depth;
  for (const dvec2& p : region.texels) length.add(glm::dot(p - region.near_end, along));
  for (const double z : region.depths) depth.add(z);
  const double d = length.size(), near = depth.low, far = depth.high;
  double distance;
  if (warp == Warp::kLispsm) {
    const double texels_per_unit = glm::length(axis) / std::max((far - near) * region.sine, 1e-12);
    distance = texels_per_unit * (near + std::sqrt(near * far)) / region.sine;
  } else {
    distance = d * (near + std::sqrt(near * far)) / std::max(far - near, 1e-12 * far);
    const double fade = std::min(region.sine / std::max(region.limit_sine, 1e-9), 1.0);
    distance /= fade * fade * (3 - 2 * fade);
  }
  for (const dvec2& p : region.texels) {
    const dvec2 q = p - region.near_end;
    const double least = std::abs(glm::dot(q, across)) / kMostOpening;
    distance = std::max(distance, least - (glm::dot(q, along) - length.low));
  }
  if (!(distance < kWeakWarp * d)) return fit_region(region, size, margin);
  warped = true;
  // a: along from the short base, p: across from the axis; w = (n' + a) / n'.
  const dvec3 a(along, -glm::dot(region.near_end, along) - length.low);
  const dvec3 p(across, -glm::dot(region.near_end, across));
  const dvec3 w = a / distance + dvec3(0, 0, 1);
  Range wide;
  for (const dvec2& t : region.texels) {
    const dvec3 h(t, 1);
    wide.add(glm::dot(p, h) / glm::dot(w, h));
  }
  const Range tall{0, d * distance / (distance + d)};
  const dvec2 fx = onto(wide, size.x, margin), fy = onto(tall, size.y, margin);
  return of_rows(fx.x * p + fx.y * w, fy.x * a + fy.y * w, w);
}

}  // namespace photohull::visibility
