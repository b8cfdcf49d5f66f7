// Whether the principal points are half a pixel off.
#include <algorithm>
#include <array>

#include "cameras/diagnose_parts.h"
#include "cameras/triangulate.h"
#include "core/median.h"

namespace photohull::diagnosis {
namespace {

/// Squared residuals for each shift, of what one view or pair of views observes.
struct ShiftCost {
  int view = 0;
  std::array<double, 3> squares{};
  double least() const { return *std::min_element(squares.begin(), squares.end()); }
};

/// Sums of inliers' costs against their spread, by view.
void add_costs(const std::vector<ShiftCost>& costs, double least_sigma, double to_sigma,
               std::vector<std::array<double, 3>>& by_view, std::array<double, 3>& rms,
               int& count) {
  constexpr double kOutlier = 4;  // spreads
  std::vector<double> lengths;
  for (const ShiftCost& c : costs) lengths.push_back(std::sqrt(c.least()));
  const double sigma = std::max(least_sigma, median(lengths) * to_sigma);
  for (const ShiftCost& c : costs) {
    if (!(c.least() < kOutlier * kOutlier * sigma * sigma)) continue;
    ++count;
    for (int s = 0; s < 3; ++s) {
      by_view[std::size_t(c.view)][s] += c.squares[s] / (sigma * sigma);
      rms[s] += c.squares[s];
    }
  }
  for (double& r : rms) r = count > 0 ? std::sqrt(r / count) : 0;
}

/// Where the parabola through the costs for -0.5, 0 and 0.5 pixels is least; NaN where nowhere.
double least_of(const std::array<double, 3>& cost) {
  const double curvature = 2 * (cost[0] + cost[2] - 2 * cost[1]), slope = cost[2] - cost[0];
  return curvature > 1e-12 ? -slope / (2 * curvature) : NAN;
}

}  // namespace

PixelCentreFit fit_pixel_centre(const Cameras& cameras, const std::vector<ViewFit>& fits,
                                const std::vector<Track>& tracks,
                                const std::vector<FrontierPair>& tangents) {
  constexpr double kMostSigma = 0.1, kNear = 0.15;  // pixels
  PixelCentreFit fit;
  std::array<Cameras, 3> shifted;
  for (int s = 0; s < 3; ++s) {
    shifted[s] = cameras;
    for (Camera& camera : shifted[s]) {
      camera.intrinsics.cx += PixelCentreFit::kShifts[s];
      camera.intrinsics.cy += PixelCentreFit::kShifts[s];
    }
  }
  std::vector<ShiftCost> track_costs, tangent_costs;
  for (const Track& track : tracks) {
    ShiftCost cost{track.observations[0].view, {}};
    bool usable = true;
    for (const Observation& o : track.observations)
      usable = usable && !fits[std::size_t(o.view)].disagrees;
    for (int s = 0; usable && s < 3; ++s) {
      const auto point = triangulate(shifted[s], track);
      usable = point.has_value();
      if (usable) cost.squares[s] = std::pow(reprojection_rms(shifted[s], track, *point), 2);
    }
    if (usable) track_costs.push_back(cost);
  }
  for (const FrontierPair& t : tangents) {
    if (fits[std::size_t(t.view_a)].disagrees || fits[std::size_t(t.view_b)].disagrees) continue;
    ShiftCost cost{t.view_a, {}};
    for (int s = 0; s < 3; ++s)
      cost.squares[s] =
          std::pow(epipolar_residual(shifted[s], t.view_a, t.view_b, t.pixel_a, t.pixel_b), 2);
    tangent_costs.push_back(cost);
  }
  std::vector<std::array<double, 3>> by_view(cameras.size(), std::array<double, 3>{});
  add_costs(track_costs, 0.03, 1 / 1.1774, by_view, fit.tracks, fit.track_count);
  add_costs(tangent_costs, 0.15, 1.4826, by_view, fit.tangents, fit.tangent_count);
  const auto sum_without = [&](std::size_t left_out) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < by_view.size(); ++i)
      for (int s = 0; i != left_out && s < 3; ++s) sum[s] += by_view[i][s];
    return sum;
  };
  const double n = double(cameras.size());
  fit.shift = least_of(sum_without(cameras.size()));
  double variance = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    variance += std::pow(least_of(sum_without(i)) - fit.shift, 2);
  fit.sigma = std::sqrt(variance * (n - 1) / n);
  if (!std::isfinite(fit.shift) || !std::isfinite(fit.sigma)) {
    fit.shift = 0;
    fit.sigma = INFINITY;
    return fit;
  }
  for (const double s : PixelCentreFit::kShifts)
    if (std::abs(fit.shift - s) < kNear && fit.sigma < kMostSigma) {
      fit.tells = true;
      fit.best = s;
    }
  return fit;
}

}  // namespace photohull::diagnosis
