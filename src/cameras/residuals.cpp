#include "cameras/residuals.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cameras/triangulate.h"
#include "core/median.h"

namespace photohull {

double spread_of_lengths(std::vector<double> lengths) {
  return median(std::move(lengths)) / 1.1774;
}

double spread_of_distances(std::vector<double> d) { return 1.4826 * median(std::move(d)); }

Triangulated triangulate_all(std::span<const Camera> cameras, std::span<const Track> tracks) {
  Triangulated result{std::vector<glm::dvec3>(tracks.size()), std::vector<double>(tracks.size())};
  tbb::parallel_for(std::size_t(0), tracks.size(), [&](std::size_t i) {
    const auto point = triangulate(cameras, tracks[i]);
    result.points[i] = point.value_or(glm::dvec3(NAN));
    result.rms[i] = point ? reprojection_rms(cameras, tracks[i], *point) : INFINITY;
  });
  return result;
}

std::vector<double> tangent_distances(std::span<const Camera> cameras,
                                      std::span<const FrontierPair> tangents) {
  std::vector<double> distances;
  for (const FrontierPair& t : tangents) {
    const glm::dvec2 d = epipolar_distances(cameras[t.view_a], cameras[t.view_b], t);
    distances.push_back(std::abs(d.x));
    distances.push_back(std::abs(d.y));
  }
  return distances;
}

double robust_cost(const std::vector<double>& residuals, double sigma) {
  if (residuals.empty()) return 0;
  constexpr double kGross = 10;  // spreads: what is farther off, or has no place, is as wrong
  double sum = 0;
  for (const double r : residuals) {
    const double spreads = std::isfinite(r) ? std::min(r / sigma, kGross) : kGross;
    sum += std::log1p(spreads * spreads / 2);
  }
  return sum / double(residuals.size());
}

}  // namespace photohull
