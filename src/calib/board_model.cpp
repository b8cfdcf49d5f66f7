#include "calib/board_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <unordered_set>
#include <vector>

#include "core/error.h"
#include "core/median.h"

namespace photohull {

glm::dmat3 rotation_of(const Rigid& pose) {
  double columns[9];
  ceres::AngleAxisToRotationMatrix(pose.data(), columns);
  glm::dmat3 r;
  for (int i = 0; i < 9; ++i) r[i / 3][i % 3] = columns[i];
  return r;
}

Pose pose_of(const Rigid& pose) { return {rotation_of(pose), {pose[3], pose[4], pose[5]}}; }

Rigid rigid_of(const Pose& pose) {
  Rigid result;
  double columns[9];
  for (int i = 0; i < 9; ++i) columns[i] = pose.rotation[i / 3][i % 3];
  ceres::RotationMatrixToAngleAxis(columns, result.data());
  for (int i = 0; i < 3; ++i) result[3 + i] = pose.translation[i];
  return result;
}

double view_rms(const BoardView& view, LensModel model, const Lens& lens, const Rigid& pose) {
  double sum = 0;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    double p[3], pixel[2];
    to_camera(pose.data(), view.points[i], p);
    project(model, lens.data(), p, pixel);
    sum += std::pow(pixel[0] - view.pixels[i].x, 2) + std::pow(pixel[1] - view.pixels[i].y, 2);
  }
  return std::sqrt(sum / double(view.points.size()));
}

double outlier_limit(const std::vector<double>& rms) {
  return std::max(kHarmlessRms, kOutlierFactor * median(rms));
}

void check_same_size(const std::vector<BoardView>& views, const std::vector<std::size_t>& used) {
  for (const std::size_t i : used)
    if (views[i].width != views[used[0]].width || views[i].height != views[used[0]].height)
      throw Error(concat(views[i].name, ": the picture is of another size than ",
                         views[used[0]].name, "; calibrate one camera at one resolution"));
}

LensModel model_of(const Distortion& distortion) {
  const auto& k = distortion.coefficients;
  switch (distortion.model) {
    case DistortionModel::kNone:
      return LensModel::kPinhole;
    case DistortionModel::kFisheye:
      return LensModel::kFisheye;
    case DistortionModel::kBrown:
      return k[5] != 0 || k[6] != 0 || k[7] != 0 ? LensModel::kRational : LensModel::kBrown;
    case DistortionModel::kPolynomial:
    case DistortionModel::kMeasured:
      break;
  }
  throw Error(
      "the known lens has distortion that boards are not calibrated with; give one that is "
      "pinhole, brown, rational or fisheye (docs/reference/formats.md)");
}

Lens lens_of(const KnownLens& known) {
  const Intrinsics& k = known.intrinsics;
  constexpr double kNoSkew = 1e-6;  // of the focal length
  if (!(std::abs(k.skew) <= kNoSkew * std::abs(k.fx)))
    throw Error(concat("the known lens has a skew of ", k.skew,
                       " px, which boards are not calibrated with; give one without"));
  Lens lens{k.fx, k.fy, k.cx, k.cy};
  std::copy(known.distortion.coefficients.begin(), known.distortion.coefficients.end(),
            lens.begin() + 4);
  return lens;
}

void hold_lens(ceres::Problem& problem, LensModel model, bool known, Lens& lens) {
  if (known) return problem.SetParameterBlockConstant(lens.data());
  std::vector<int> fixed;
  const auto fix_from = [&](int first) {
    for (int i = first; i < 12; ++i) fixed.push_back(i);
  };
  switch (model) {
    case LensModel::kPinhole:
      fix_from(4);
      break;
    case LensModel::kBrown:
      fix_from(9);
      break;
    case LensModel::kFisheye:
      fix_from(8);
      break;
    case LensModel::kRational:
      return;
  }
  problem.SetManifold(lens.data(), new ceres::SubsetManifold(12, fixed));
}

namespace {

/// All parameter blocks, as the residuals use them: Ceres lists them by their addresses, which
/// differ from run to run, and sums with them.
std::vector<double*> blocks_in_order(const ceres::Problem& problem) {
  std::vector<ceres::ResidualBlockId> residuals;
  problem.GetResidualBlocks(&residuals);
  std::vector<double*> all, some;
  std::unordered_set<double*> known;
  for (const ceres::ResidualBlockId residual : residuals) {
    problem.GetParameterBlocksForResidualBlock(residual, &some);
    for (double* block : some)
      if (known.insert(block).second) all.push_back(block);
  }
  return all;
}

}  // namespace

void solve(ceres::Problem& problem, const std::vector<double*>& eliminated) {
  ceres::Solver::Options options;
  options.linear_solver_type = eliminated.empty() ? ceres::DENSE_QR : ceres::DENSE_SCHUR;
  if (!eliminated.empty()) {
    auto* ordering = new ceres::ParameterBlockOrdering;
    int group = 1;
    for (double* block : blocks_in_order(problem)) ordering->AddElementToGroup(block, group++);
    for (double* block : eliminated) ordering->AddElementToGroup(block, 0);
    options.linear_solver_ordering.reset(ordering);
  }
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable())
    throw Error("the calibration does not converge; photograph the board from more sides");
}

StandardDeviations::StandardDeviations(ceres::Problem& problem) : problem_(problem) {
  int columns = 0;
  for (double* block : blocks_in_order(problem)) {
    if (problem.IsParameterBlockConstant(block)) continue;
    blocks_.push_back(block);
    first_.push_back(columns);
    columns += problem.ParameterBlockTangentSize(block);
  }
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = blocks_;
  double cost = 0;
  ceres::CRSMatrix j;
  if (!problem.Evaluate(evaluate, &cost, nullptr, nullptr, &j)) return;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(columns, columns);
  for (int row = 0; row < j.num_rows; ++row)
    for (int a = j.rows[row]; a < j.rows[row + 1]; ++a)
      for (int b = j.rows[row]; b < j.rows[row + 1]; ++b)
        normal(j.cols[a], j.cols[b]) += j.values[a] * j.values[b];
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> solver(scale.asDiagonal() * normal * scale.asDiagonal());
  constexpr double kDegenerate = 1e-13;
  if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > kDegenerate)) return;
  const double spread = 2 * cost / std::max(1, j.num_rows - columns);
  covariance_ = spread * scale.asDiagonal() *
                solver.solve(Eigen::MatrixXd::Identity(columns, columns)) * scale.asDiagonal();
}

std::vector<double> StandardDeviations::of(const double* block) const {
  const auto found = std::find(blocks_.begin(), blocks_.end(), block);
  if (covariance_.size() == 0 || found == blocks_.end()) return {};
  const int first = first_[std::size_t(found - blocks_.begin())];
  std::vector<double> sigma;
  for (int i = 0; i < problem_.ParameterBlockTangentSize(block); ++i)
    sigma.push_back(std::sqrt(std::max(0.0, covariance_(first + i, first + i))));
  sigma.resize(std::size_t(problem_.ParameterBlockSize(block)), 0.0);
  return sigma;
}

void set_lens(const Lens& lens, LensModel model, int width, int height, Intrinsics& intrinsics,
              Distortion& distortion) {
  intrinsics = {width, height, lens[0], lens[1], 0, lens[2], lens[3]};
  distortion = {};
  if (model == LensModel::kFisheye) distortion.model = DistortionModel::kFisheye;
  if (model == LensModel::kBrown || model == LensModel::kRational)
    distortion.model = DistortionModel::kBrown;
  std::copy(lens.begin() + 4, lens.end(), distortion.coefficients.begin());
}

glm::dvec2 dot_bias(LensModel model, const Lens& lens, const Rigid& pose, const glm::dvec3& centre,
                    double radius) {
  constexpr int kSides = 32;
  const auto imaged = [&](const glm::dvec3& point) {
    double p[3], pixel[2];
    to_camera(pose.data(), point, p);
    project(model, lens.data(), p, pixel);
    return glm::dvec2(pixel[0], pixel[1]);
  };
  const glm::dvec2 middle = imaged(centre);
  double area = 0;
  glm::dvec2 moment(0.0), before(0.0);
  for (int i = 0; i <= kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    const glm::dvec2 rim =
        imaged(centre + radius * glm::dvec3(std::cos(angle), std::sin(angle), 0)) - middle;
    if (i > 0) {
      const double part = before.x * rim.y - before.y * rim.x;
      area += part;
      moment += part * (before + rim);
    }
    before = rim;
  }
  return area != 0 ? moment / (3 * area) : glm::dvec2(0.0);
}

}  // namespace photohull
