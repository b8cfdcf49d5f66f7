// Based on: B. Triggs et al., "Bundle adjustment: a modern synthesis", 1999 [Triggs99].
#include "calib/object_error.h"

#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <cmath>
#include <limits>

namespace photohull {

double ObjectError::rms() const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd& covariance = sigmas_.covariance();
  if (covariance.size() == 0 || residuals_.empty()) return kInfinite;
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = sigmas_.blocks();
  evaluate.residual_blocks = residuals_;
  ceres::CRSMatrix j;
  if (!problem_.Evaluate(evaluate, nullptr, nullptr, nullptr, &j)) return kInfinite;
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> by_parameters(
      j.num_rows, j.num_cols, Eigen::Index(j.values.size()), j.rows.data(), j.cols.data(),
      j.values.data());
  Eigen::MatrixXd gauge(j.num_rows, 7);
  for (int i = 0; i < j.num_rows; ++i)
    for (int c = 0; c < 7; ++c) gauge(i, c) = gauges_[std::size_t(i / 2)][std::size_t(c)][i % 2];
  const Eigen::MatrixXd free = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(gauge).householderQ() *
                               Eigen::MatrixXd::Identity(j.num_rows, 7);
  // The trace of (1 - free free^T) J C J^T.
  const Eigen::MatrixXd spread = by_parameters * covariance,
                        seen = free.transpose() * by_parameters;
  double all = 0;
  for (int row = 0; row < j.num_rows; ++row)
    for (int a = j.rows[row]; a < j.rows[row + 1]; ++a) all += spread(row, j.cols[a]) * j.values[a];
  const double taken_back = (seen * covariance * seen.transpose()).trace();
  return std::sqrt(std::max(0.0, all - taken_back) / double(residuals_.size()));
}

std::vector<glm::dvec3> points_throughout(const glm::dvec3& low, const glm::dvec3& high) {
  constexpr int kSide = 4;
  std::vector<glm::dvec3> points;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const glm::dvec3 at(i % kSide, i / kSide % kSide, i / (kSide * kSide));
    points.push_back(glm::mix(low, high, at / double(kSide - 1)));
  }
  return points;
}

std::vector<glm::dvec3> points_around_board(const SingleCamera& camera) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const std::size_t i : camera.used)
    for (const glm::dvec3& p : camera.views[i].points)
      low = glm::min(low, p), high = glm::max(high, p);
  const glm::dvec3 side = high - low, middle = 0.5 * (low + high);
  const glm::dvec3 half(0.5 * std::max({side.x, side.y, side.z}));
  return points_throughout(middle - half, middle + half);
}

}  // namespace photohull
