#include "assess/common_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/median.h"

namespace photohull::assess {
namespace {

constexpr int kSteps = 8;
constexpr double kSmallShift = 1e-3;   // pixels, of a step: the last one
constexpr double kSmallFactor = 1e-5;  // of its logarithm
constexpr std::size_t kFewestTangents = 24;
constexpr double kLeastSpread = 0.05;  // pixels, of tangents
constexpr double kOutlier = 3;         // spreads
constexpr double kToSigma = 1.4826;    // from the median of absolute values
constexpr double kMended = 0.6;        // of the disagreement, left at most
constexpr double kCertain = 5;         // standard deviations
constexpr double kLeastShift = 1;      // pixels
constexpr double kLeastFactor = 0.03;  // beside one
// Steps of the derivatives: pixels, pixels, logarithm of the factor.
constexpr std::array<double, 3> kProbe = {0.25, 0.25, 0.005};

using Change = glm::dvec3;  // of the principal points, pixels, and of the focal lengths' logarithm

std::vector<Camera> changed(std::span<const Camera> cameras, const Change& change) {
  std::vector<Camera> out(cameras.begin(), cameras.end());
  for (Camera& camera : out) {
    camera.intrinsics.cx += change.x;
    camera.intrinsics.cy += change.y;
    camera.intrinsics.fx *= std::exp(change.z);
    camera.intrinsics.fy *= std::exp(change.z);
  }
  return out;
}

/// Signed, pixels, in the first of the two views.
double distance(std::span<const Camera> cameras, const FrontierPair& pair) {
  return epipolar_distances(cameras[pair.view_a], cameras[pair.view_b], pair).x;
}

/// What the tangents ask for at `change`.
struct Equations {
  glm::dmat3 normal{0.0};
  glm::dvec3 right{0.0};
  double spread = 0;  ///< pixels
  double median = 0;  ///< pixels, of the absolute distances
  std::size_t tangents = 0;
};

Equations equations_at(std::span<const Camera> given, std::span<const Outline> outlines,
                       const Change& change) {
  const std::vector<Camera> cameras = changed(given, change);
  const std::vector<FrontierPair> pairs = frontier_pairs(cameras, outlines);
  std::array<std::vector<Camera>, 3> probed;
  for (int k = 0; k < 3; ++k) {
    Change probe(0.0);
    probe[k] = kProbe[k];
    probed[k] = changed(given, change + probe);
  }
  std::vector<double> residuals, sizes;
  for (const FrontierPair& pair : pairs) {
    residuals.push_back(distance(cameras, pair));
    sizes.push_back(std::abs(residuals.back()));
  }
  Equations e;
  e.tangents = pairs.size();
  e.median = median(sizes);
  e.spread = std::max(kLeastSpread, kToSigma * e.median);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (sizes[i] > kOutlier * e.spread) continue;
    glm::dvec3 slope;
    for (int k = 0; k < 3; ++k)
      slope[k] = (distance(probed[k], pairs[i]) - residuals[i]) / kProbe[k];
    e.normal += glm::outerProduct(slope, slope);
    e.right -= residuals[i] * slope;
  }
  return e;
}

}  // namespace

bool CommonError::mends() const { return tangents > 0 && after < kMended * before; }

bool CommonError::shift_counts() const {
  const double length = glm::length(shift);
  return mends() && length > kLeastShift && length > kCertain * shift_sigma;
}

bool CommonError::focal_counts() const {
  const double factor = std::abs(std::log(focal_factor));
  return mends() && factor > kLeastFactor && factor > kCertain * focal_sigma;
}

CommonError find_common_error(std::span<const Camera> cameras, std::span<const Outline> outlines) {
  CommonError error;
  Change change(0.0);
  Equations e = equations_at(cameras, outlines, change);
  error.before = e.median;
  for (int step = 0; step < kSteps; ++step) {
    if (e.tangents < kFewestTangents || !(glm::determinant(e.normal) > 0)) return {};
    const Change move = glm::inverse(e.normal) * e.right;
    change += move;
    if (!(std::abs(change.z) < 1)) return {};  // no camera is so wrong: tangents tell nothing
    e = equations_at(cameras, outlines, change);
    if (glm::length(glm::dvec2(move)) < kSmallShift && std::abs(move.z) < kSmallFactor) break;
  }
  if (e.tangents < kFewestTangents || !(glm::determinant(e.normal) > 0)) return {};
  const glm::dmat3 covariance = e.spread * e.spread * glm::inverse(e.normal);
  error.shift = glm::dvec2(change);
  error.focal_factor = std::exp(change.z);
  error.shift_sigma = std::sqrt(std::max(covariance[0][0], covariance[1][1]));
  error.focal_sigma = std::sqrt(covariance[2][2]);
  error.after = e.median;
  error.tangents = int(e.tangents);
  return error;
}

}  // namespace photohull::assess
