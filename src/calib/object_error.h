// What an uncertain calibration does to a reconstruction. Internal to calib; only for files that
// know Ceres.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "calib/board_model.h"

namespace photohull {

/// Pixels by which points of an object are seen elsewhere, as the standard deviations of a solved
/// problem have it [Triggs99]: the covariance of all parameters, correlations included, propagated
/// to the points' pixels in first order, less what a similarity of the world can take back.
class ObjectError {
 public:
  /// The problem and the deviations of its solution outlive this.
  ObjectError(ceres::Problem& problem, const StandardDeviations& sigmas)
      : problem_(problem), sigmas_(sigmas) {}

  /// A point of the object in a view, by the residual that the problem has for a board's:
  /// `residual` has the world's `point`. `blocks`: of its view, in the problem. Does not count
  /// where the picture, of `frame` pixels, does not show it.
  template <typename Residual, int... sizes, typename... Blocks>
  void add(const glm::ivec2& frame, Residual residual, Blocks*... blocks) {
    residual.pixel = {};
    const auto at = [&](const glm::dvec3& place, glm::dvec2& pixel) {
      Residual moved = residual;
      moved.point = place;
      return moved(static_cast<const double*>(blocks)..., &pixel.x);
    };
    Gauge gauge;
    if (!on_frame(at, frame, residual.point) || !turn_world(at, residual.point, gauge)) return;
    gauges_.push_back(gauge);
    residuals_.push_back(problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Residual, 2, sizes...>(new Residual(residual)), nullptr,
        blocks...));
  }

  /// Pixels, root mean square; infinite where the problem is degenerate or no point is seen.
  double rms() const;

 private:
  using Gauge = std::array<glm::dvec2, 7>;  ///< of a pixel, by turns, shifts and scale

  template <typename At>
  static bool on_frame(const At& at, const glm::ivec2& frame, const glm::dvec3& place) {
    glm::dvec2 p;
    return at(place, p) && p.x > -0.5 && p.y > -0.5 && p.x < frame.x - 0.5 && p.y < frame.y - 0.5;
  }

  /// Derivatives by the similarity of the world about its origin, from central differences.
  template <typename At>
  static bool turn_world(const At& at, const glm::dvec3& place, Gauge& gauge) {
    const double step = 1e-6 * (glm::length(place) + 1e-12);
    glm::dmat3x2 by_place;
    for (int i = 0; i < 3; ++i) {
      glm::dvec3 shift(0.0);
      shift[i] = step;
      glm::dvec2 after, before;
      if (!at(place + shift, after) || !at(place - shift, before)) return false;
      by_place[i] = (after - before) / (2 * step);
    }
    for (int i = 0; i < 3; ++i) {
      glm::dvec3 axis(0.0);
      axis[i] = 1;
      gauge[std::size_t(i)] = by_place * glm::cross(axis, place);
      gauge[std::size_t(3 + i)] = by_place[i];
    }
    gauge[6] = by_place * place;
    return true;
  }

  ceres::Problem& problem_;
  const StandardDeviations& sigmas_;
  std::vector<Gauge> gauges_;
  std::vector<ceres::ResidualBlockId> residuals_;
};

/// Places of a cube about the middle of the board's points that the views used show, as large as
/// their longest side, in the board's frame: an object stands on the board, on either side.
std::vector<glm::dvec3> points_around_board(const SingleCamera& camera);

/// Places throughout a box, its corners among them.
std::vector<glm::dvec3> points_throughout(const glm::dvec3& low, const glm::dvec3& high);

}  // namespace photohull
