// Based on: B. Triggs et al., "Bundle adjustment: a modern synthesis", 1999 [Triggs99].
#include "cameras/bundle.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cameras/moved_camera.h"

namespace photohull {
namespace {

// Steps of one adjustment, and the share of the cost by which the last one lowers it. The next
// adjustment finds outliers and tangents anew, so the first few steps are what it needs of this
// one, unless cameras are far from where they belong: beyond kFar pixels of residuals.
constexpr double kFar = 1;
constexpr int kIterations = 12, kIterationsFromFar = 30;
constexpr double kSettled = 1e-5, kSettledFromFar = 1e-7;
constexpr int kInvalidSteps = 20;  // in a row, with a point behind a camera: then it gives up

using Unit6 = std::array<double, 6>;

/// What an adjustment moves: its cameras and points, and what all cameras share. `cameras` are
/// moved by `poses`, once for all residuals.
struct Unknowns : ceres::EvaluationCallback {
  std::vector<Motion> motions;
  std::vector<Unit6> poses;
  std::vector<MovedCamera> cameras;
  std::vector<glm::dvec3> points;
  SharedUnknowns shared{0, 0, 0};

  void PrepareForEvaluation(bool, bool new_point) override {
    if (!new_point) return;
    for (std::size_t i = 0; i < poses.size(); ++i)
      cameras[i] = MovedCamera(motions[i], poses[i].data());
  }
};

/// Weighted derivatives of two residuals to where Ceres wants them, row by row.
template <std::size_t N>
void put(const std::array<std::array<double, N>, 2>& rows, double weight, double* to) {
  if (!to) return;
  for (const auto& row : rows)
    for (const double value : row) *to++ = weight * value;
}

/// Of a pose, a point, and what all cameras share.
class TrackCost : public ceres::SizedCostFunction<2, 6, 3, 3> {
 public:
  TrackCost(const Unknowns& all, int view, glm::dvec2 pixel, double weight)
      : all_(all), view_(std::size_t(view)), pixel_(pixel), weight_(weight) {}

  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override {
    const double *point = unknowns[1], *shared = unknowns[2];
    TrackDerivatives by;
    glm::dvec2 residual;
    if (!track_residual(all_.cameras[view_], {shared[0], shared[1], shared[2]},
                        {point[0], point[1], point[2]}, pixel_, residual,
                        jacobians ? &by : nullptr))
      return false;
    residuals[0] = weight_ * residual.x;
    residuals[1] = weight_ * residual.y;
    if (!jacobians) return true;
    put(by.by_pose, weight_, jacobians[0]);
    put(by.by_point, weight_, jacobians[1]);
    put(by.by_shared, weight_, jacobians[2]);
    return true;
  }

 private:
  const Unknowns& all_;
  std::size_t view_;
  glm::dvec2 pixel_;
  double weight_;
};

/// Of two poses, and what all cameras share.
class TangentCost : public ceres::SizedCostFunction<2, 6, 6, 3> {
 public:
  TangentCost(const Unknowns& all, const FrontierPair& pair, double weight)
      : all_(all), pair_(pair), weight_(weight) {}

  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override {
    const double* shared = unknowns[2];
    TangentDerivatives by;
    const glm::dvec2 residual = tangent_residual(
        all_.cameras[std::size_t(pair_.view_a)], all_.cameras[std::size_t(pair_.view_b)],
        {shared[0], shared[1], shared[2]}, pair_, jacobians ? &by : nullptr);
    residuals[0] = weight_ * residual.x;
    residuals[1] = weight_ * residual.y;
    if (!jacobians) return true;
    put(by.by_pose_a, weight_, jacobians[0]);
    put(by.by_pose_b, weight_, jacobians[1]);
    put(by.by_shared, weight_, jacobians[2]);
    return true;
  }

 private:
  const Unknowns& all_;
  FrontierPair pair_;
  double weight_;
};

/// Holds a camera near where it was given, by springs in pixels.
struct PriorResidual {
  double sigma;  ///< pixels, about

  template <typename T>
  bool operator()(const T* pose, T* residual) const {
    for (int i = 0; i < 6; ++i) residual[i] = pose[i] / sigma;
    return true;
  }
};

void add_residuals(const BundleInput& input, Unknowns& u, ceres::Problem& problem) {
  constexpr double kTail = 3;
  // One each for all residuals, which the problem owns.
  auto* const loss = new ceres::CauchyLoss(kTail);
  auto* const prior =
      new ceres::AutoDiffCostFunction<PriorResidual, 6, 6>(new PriorResidual{input.prior_sigma});
  for (std::size_t t = 0; t < u.points.size(); ++t)
    for (const Observation& o : input.tracks[t].observations)
      problem.AddResidualBlock(new TrackCost(u, o.view, o.pixel, 1 / input.track_sigma), loss,
                               u.poses[std::size_t(o.view)].data(), &u.points[t].x,
                               u.shared.data());
  for (const FrontierPair& pair : input.tangents)
    problem.AddResidualBlock(new TangentCost(u, pair, 1 / input.tangent_sigma), loss,
                             u.poses[std::size_t(pair.view_a)].data(),
                             u.poses[std::size_t(pair.view_b)].data(), u.shared.data());
  for (auto& pose : u.poses) problem.AddResidualBlock(prior, nullptr, pose.data());
}

/// Holds what is not to move.
void hold(const BundleInput& input, Unknowns& u, ceres::Problem& problem) {
  if (input.hold_poses)
    for (auto& pose : u.poses) problem.SetParameterBlockConstant(pose.data());
  for (const int view : input.held)
    problem.SetParameterBlockConstant(u.poses[std::size_t(view)].data());
  if (!problem.HasParameterBlock(u.shared.data())) return;
  if (input.intrinsics == SharedIntrinsics::kNone)
    problem.SetParameterBlockConstant(u.shared.data());
  else if (input.intrinsics == SharedIntrinsics::kPixelCentre)
    problem.SetManifold(u.shared.data(), new ceres::SubsetManifold(3, {0}));
}

/// Points are eliminated first, where there are any.
void order_unknowns(Unknowns& u, const ceres::Problem& problem, ceres::Solver::Options& options) {
  options.linear_solver_type = u.points.empty() ? ceres::DENSE_QR : ceres::DENSE_SCHUR;
  if (u.points.empty()) return;
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  ceres::ParameterBlockOrdering& ordering = *options.linear_solver_ordering;
  for (glm::dvec3& point : u.points) ordering.AddElementToGroup(&point.x, 0);
  for (auto& pose : u.poses) ordering.AddElementToGroup(pose.data(), 1);
  if (problem.HasParameterBlock(u.shared.data())) ordering.AddElementToGroup(u.shared.data(), 1);
}

}  // namespace

std::vector<Camera> adjust_bundle(const BundleInput& input, std::span<const Camera> start,
                                  std::span<const Camera> prior, std::array<double, 3>& shared) {
  Unknowns u;
  u.points = input.points;
  for (std::size_t i = 0; i < prior.size(); ++i) {
    Motion motion(prior[i], input.middle);
    motion.camera.intrinsics = start[i].intrinsics;
    u.poses.push_back(motion.unknowns_to(start[i].cam_from_world));
    u.motions.push_back(motion);
  }
  u.cameras.resize(prior.size());
  ceres::Problem::Options evaluation;
  evaluation.evaluation_callback = &u;
  ceres::Problem problem(evaluation);
  add_residuals(input, u, problem);
  hold(input, u, problem);
  ceres::Solver::Options options;
  order_unknowns(u, problem, options);
  // Where most views are held, residuals do not tell how far the others are.
  const bool far = !input.held.empty() || std::max(input.track_sigma, input.tangent_sigma) > kFar;
  options.max_num_iterations = far ? kIterationsFromFar : kIterations;
  options.function_tolerance = far ? kSettledFromFar : kSettled;
  options.max_num_consecutive_invalid_steps = kInvalidSteps;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;  // sums in the same order on every machine
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::vector<Camera> result(start.begin(), start.end());
  if (!summary.IsSolutionUsable()) {
    shared = {1, 0, 0};
    return result;
  }
  const double focal = std::exp(u.shared[0] * kFocalUnit);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (std::find(input.held.begin(), input.held.end(), int(i)) == input.held.end())
      result[i].cam_from_world = MovedCamera(u.motions[i], u.poses[i].data()).pose;
    Intrinsics& k = result[i].intrinsics;
    k.fx *= focal, k.fy *= focal, k.skew *= focal;
    k.cx += u.shared[1], k.cy += u.shared[2];
  }
  shared = {focal, u.shared[1], u.shared[2]};
  return result;
}

}  // namespace photohull
