// Based on: B. Efron, "The jackknife, the bootstrap and other resampling plans", 1982 [Efron82].
#include "cameras/motion_jackknife.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <map>

namespace photohull {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Normal equations of the motion.
struct Normal {
  Matrix6 h = Matrix6::Zero();
  Vector6 g = Vector6::Zero();

  void add(const Normal& o, double factor) { h += factor * o.h, g += factor * o.g; }
};

/// A track's part in them, without one view (-1: with all): its point is solved for.
Normal part_of(const std::vector<LinearPixel>& track, int without) {
  Normal part;
  Eigen::Matrix<double, 6, 3> across = Eigen::Matrix<double, 6, 3>::Zero();
  Eigen::Matrix3d point = Eigen::Matrix3d::Zero();
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  bool fixed = false, moved = false;
  for (const LinearPixel& pixel : track) {
    if (pixel.view == without) continue;
    (pixel.moved ? moved : fixed) = true;
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Map<const Vector6> m(pixel.by_motion[k].data());
      const Eigen::Map<const Eigen::Vector3d> p(pixel.by_point[k].data());
      part.h += m * m.transpose();
      part.g += pixel.residual[k] * m;
      across += m * p.transpose();
      point += p * p.transpose();
      slope += pixel.residual[k] * p;
    }
  }
  const Eigen::LDLT<Eigen::Matrix3d> solved(point);
  if (!fixed || !moved || !(solved.rcond() > 1e-12)) return {};
  part.h -= across * solved.solve(across.transpose());
  part.g -= across * solved.solve(slope);
  return part;
}

}  // namespace

std::optional<MotionCovariance> jackknife(std::span<const std::vector<LinearPixel>> tracks) {
  Normal all;
  std::map<int, Normal> lost;  // of each view: what goes with it
  for (const std::vector<LinearPixel>& track : tracks) {
    const Normal whole = part_of(track, -1);
    all.add(whole, 1);
    for (const LinearPixel& pixel : track) {
      lost[pixel.view].add(whole, 1);
      lost[pixel.view].add(part_of(track, pixel.view), -1);
    }
  }
  Matrix6 sum = Matrix6::Zero();
  for (const auto& [view, loss] : lost) {
    Normal rest = all;
    rest.add(loss, -1);
    const Eigen::LDLT<Matrix6> solved(rest.h);
    if (!solved.isPositive() || !(solved.rcond() > 1e-14)) return std::nullopt;
    const Vector6 change = solved.solve(rest.g);
    sum += change * change.transpose();
  }
  const double count = double(lost.size());
  sum *= (count - 1) / count;
  MotionCovariance covariance{};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) covariance[std::size_t(i)][std::size_t(j)] = sum(i, j);
  return covariance;
}

}  // namespace photohull
