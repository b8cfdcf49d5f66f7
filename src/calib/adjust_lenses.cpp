// Based on: B. Triggs et al., "Bundle adjustment: a modern synthesis", 1999 [Triggs99].
#include "calib/adjust_lenses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "calib/board_model.h"
#include "core/error.h"
#include "core/median.h"

namespace photohull {
namespace {

/// Measured in docs/design/decisions/0024-where-principal-points-are-told.md.
constexpr double kMiddle = 0.015;  // of the longer side: spread of principal points
constexpr double kAlike = 3;       // errors of tracks are correlated: they count so much larger
constexpr double kTail = 3;        // deviations of the noise, beyond which tracks lose weight
/// Loose: they keep what a single photograph of a plane would leave open.
constexpr double kFocal = 0.2;   // deviation of the focal length's logarithm from the found one
constexpr double kRadial = 0.5;  // of the radial term from none

constexpr double kFarthest = 10;  // pixels: tracks that disagree more with the given cameras go
constexpr double kParallel = 1e-6;
constexpr int kLensSize = 4, kPoseSize = 6;

using RadialLens = std::array<double, kLensSize>;  ///< focal length, principal point, radial term

/// From an observed pixel to the projection of a point, in pixels.
struct TrackResidual {
  glm::dvec2 pixel;

  template <typename T>
  bool operator()(const T* lens, const T* pose, const T* point, T* residual) const {
    T p[3];
    ceres::AngleAxisRotatePoint(pose, point, p);
    for (int i = 0; i < 3; ++i) p[i] += pose[3 + i];
    if (!(p[2] > 0.0)) return false;
    const T x = p[0] / p[2], y = p[1] / p[2];
    const T scale = lens[0] * (1.0 + lens[3] * (x * x + y * y));
    residual[0] = scale * x + lens[1] - pixel.x;
    residual[1] = scale * y + lens[2] - pixel.y;
    return true;
  }
};

/// What is known of a lens before any photograph.
struct RadialLensPrior {
  double focal;       ///< pixels, as it was found
  glm::dvec2 middle;  ///< of the photograph, pixels
  double spread;      ///< of the principal point, pixels

  template <typename T>
  bool operator()(const T* lens, T* residual) const {
    using std::log;
    if (!(lens[0] > 0.0)) return false;
    residual[0] = log(lens[0] / focal) / kFocal;
    residual[1] = (lens[1] - middle.x) / spread;
    residual[2] = (lens[2] - middle.y) / spread;
    residual[3] = lens[3] / kRadial;
    return true;
  }
};

/// Asks for cancellation between two steps.
struct CancelledStep : ceres::IterationCallback {
  explicit CancelledStep(const Progress& asked) : progress(asked) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return progress.cancelled() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }
  const Progress& progress;
};

/// The direction (x, y, 1) that a pixel shows.
glm::dvec3 direction(const RadialLens& lens, const glm::dvec2& pixel) {
  constexpr int kSteps = 10;
  const glm::dvec2 seen = (pixel - glm::dvec2(lens[1], lens[2])) / lens[0];
  glm::dvec2 ideal = seen;
  for (int i = 0; i < kSteps; ++i) ideal = seen / (1 + lens[3] * glm::dot(ideal, ideal));
  return {ideal, 1.0};
}

/// The adjustment. The world's axes are those of the first camera, which does not move.
class Bundle {
 public:
  Bundle(const Scene& scene, const std::vector<std::size_t>& lens_of_view);

  bool has_tracks() const { return poses_.size() > 1 && !points_.empty(); }
  /// False where it does not succeed.
  bool solve(Progress& progress);
  /// Empty where they are not determined.
  std::vector<AdjustedLens> deviations();
  void write(Scene& scene, std::vector<AdjustedLens>& lenses) const;

 private:
  struct Seen {  ///< what sees an observation
    RadialLens& lens;
    Rigid& pose;
  };
  Seen seen(const SceneTrack::Observation& o) {
    return {lenses_[lens_of_view_[std::size_t(o.view)]], poses_[std::size_t(o.view)]};
  }
  std::optional<glm::dvec3> triangulate(const SceneTrack& track);
  /// Pixels; infinite behind a camera.
  double error(const SceneTrack::Observation& o, const glm::dvec3& point);
  double noise();
  void add_all(ceres::Problem& problem);
  void hold_world(ceres::Problem& problem);
  bool solve(ceres::Problem& problem, Progress& progress);
  std::vector<double*> blocks_of_cameras(const ceres::Problem& problem);
  Eigen::MatrixXd reduced_normal(const ceres::CRSMatrix& jacobian, int columns) const;

  std::vector<std::size_t> lens_of_view_;
  std::vector<RadialLens> lenses_;
  std::vector<RadialLensPrior> priors_;
  std::vector<Rigid> poses_;
  std::vector<SceneTrack> tracks_;
  std::vector<glm::dvec3> points_;  ///< as many
  double noise_ = 1;                ///< pixels, of one coordinate
  Pose world_;                      ///< of the scene, as the first camera has it
};

Bundle::Bundle(const Scene& scene, const std::vector<std::size_t>& lens_of_view)
    : lens_of_view_(lens_of_view) {
  if (scene.views.empty()) return;
  const std::size_t count = *std::ranges::max_element(lens_of_view) + 1;
  lenses_.resize(count), priors_.resize(count);
  world_ = scene.views[0].camera.cam_from_world;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const auto& [k, pose] = scene.views[i].camera;
    const std::size_t lens = lens_of_view[i];
    lenses_[lens] = {k.fx, k.cx, k.cy, scene.views[i].distortion.coefficients[0]};
    priors_[lens] = {k.fx, 0.5 * glm::dvec2(k.width - 1, k.height - 1),
                     kMiddle * std::max(k.width, k.height)};
    const glm::dmat3 turn = pose.rotation * glm::transpose(world_.rotation);
    poses_.push_back(rigid_of({turn, pose.translation - turn * world_.translation}));
  }
  for (const SceneTrack& track : scene.tracks) {
    const std::optional<glm::dvec3> point = triangulate(track);
    if (!point) continue;
    tracks_.push_back(track);
    points_.push_back(*point);
  }
}

/// Where the rays pass each other nearest. Nothing where they are parallel, or do not agree.
std::optional<glm::dvec3> Bundle::triangulate(const SceneTrack& track) {
  glm::dmat3 normal(0.0);
  glm::dvec3 right(0.0);
  for (const SceneTrack::Observation& o : track.observations) {
    const auto [lens, pose] = seen(o);
    const glm::dmat3 world_from_camera = glm::transpose(rotation_of(pose));
    const glm::dvec3 ray = glm::normalize(world_from_camera * direction(lens, o.pixel));
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(ray, ray);
    normal += across;
    right -= across * (world_from_camera * glm::dvec3(pose[3], pose[4], pose[5]));
  }
  if (!(glm::determinant(normal) > kParallel)) return std::nullopt;
  const glm::dvec3 point = glm::inverse(normal) * right;
  const bool agrees = std::ranges::all_of(
      track.observations, [&](const auto& o) { return error(o, point) < kFarthest; });
  return agrees ? std::optional(point) : std::nullopt;
}

double Bundle::error(const SceneTrack::Observation& o, const glm::dvec3& point) {
  const auto [lens, pose] = seen(o);
  glm::dvec2 off;
  if (!TrackResidual{o.pixel}(lens.data(), pose.data(), &point.x, &off.x)) return INFINITY;
  return glm::length(off);
}

/// Spread of the residuals by their median, which few wrong tracks do not change.
double Bundle::noise() {
  std::vector<double> errors;
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    for (const auto& o : tracks_[t].observations) errors.push_back(error(o, points_[t]));
  const double median_of_unit = std::sqrt(2 * std::log(2.0));  // of two normal coordinates
  const double rows = 2 * double(errors.size());
  const double unknowns =
      double(3 * points_.size() + kPoseSize * poses_.size() + kLensSize * lenses_.size());
  constexpr double kLeast = 0.01;  // pixels
  return std::max(
      kLeast, median(errors) / median_of_unit * std::sqrt(rows / std::max(1.0, rows - unknowns)));
}

void Bundle::add_all(ceres::Problem& problem) {
  auto* const loss = new ceres::ScaledLoss(new ceres::CauchyLoss(kTail * noise_),
                                           std::pow(kAlike * noise_, -2), ceres::TAKE_OWNERSHIP);
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    for (const auto& o : tracks_[t].observations)
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<TrackResidual, 2, kLensSize, kPoseSize, 3>(
              new TrackResidual{o.pixel}),
          loss, seen(o).lens.data(), seen(o).pose.data(), &points_[t].x);
  for (std::size_t l = 0; l < lenses_.size(); ++l)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<RadialLensPrior, kLensSize, kLensSize>(
                                 new RadialLensPrior(priors_[l])),
                             nullptr, lenses_[l].data());
  hold_world(problem);
}

/// Holds the first camera, and of the one that is farthest from it the largest coordinate.
void Bundle::hold_world(ceres::Problem& problem) {
  std::size_t farthest = 0, axis = 3;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (!problem.HasParameterBlock(poses_[i].data())) continue;
    for (std::size_t a = 3; a < kPoseSize; ++a)
      if (std::abs(poses_[i][a]) > std::abs(poses_[farthest][axis])) farthest = i, axis = a;
  }
  if (problem.HasParameterBlock(poses_[0].data()))
    problem.SetParameterBlockConstant(poses_[0].data());
  if (farthest > 0)
    problem.SetManifold(poses_[farthest].data(), new ceres::SubsetManifold(kPoseSize, {int(axis)}));
}

bool Bundle::solve(ceres::Problem& problem, Progress& progress) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  auto* const ordering = new ceres::ParameterBlockOrdering;
  for (glm::dvec3& point : points_) ordering->AddElementToGroup(&point.x, 0);
  for (Rigid& pose : poses_)
    if (problem.HasParameterBlock(pose.data())) ordering->AddElementToGroup(pose.data(), 1);
  for (RadialLens& lens : lenses_) ordering->AddElementToGroup(lens.data(), 1);
  options.linear_solver_ordering.reset(ordering);
  options.initial_trust_region_radius = 1e8;  // what tracks tell little of is far, and smooth
  options.max_num_iterations = 60;
  options.function_tolerance = 1e-6;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;  // sums in the same order on every machine
  CancelledStep cancelled(progress);
  options.callbacks.push_back(&cancelled);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  progress.check_cancelled();
  return summary.IsSolutionUsable();
}

bool Bundle::solve(Progress& progress) {
  constexpr int kTimes = 2;  // the second with the noise that the first one's residuals have
  for (int round = 0; round < kTimes; ++round) {
    noise_ = noise();
    ceres::Problem problem;
    add_all(problem);
    if (!solve(problem, progress)) return false;
    progress.update(double(round + 1) / kTimes);
  }
  return true;
}

/// Lenses first, then poses; of all that move.
std::vector<double*> Bundle::blocks_of_cameras(const ceres::Problem& problem) {
  std::vector<double*> blocks;
  for (RadialLens& lens : lenses_) blocks.push_back(lens.data());
  for (Rigid& pose : poses_)
    if (problem.HasParameterBlock(pose.data()) && !problem.IsParameterBlockConstant(pose.data()))
      blocks.push_back(pose.data());
  return blocks;
}

/// The normal matrix of lenses and poses, the first `columns`, with points eliminated: the Schur
/// complement. Rows are those of the tracks, one after the other, and of the priors.
Eigen::MatrixXd Bundle::reduced_normal(const ceres::CRSMatrix& j, int columns) const {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(columns, columns);
  int row = 0;
  const auto add = [&] {
    for (int a = j.rows[row]; a < j.rows[row + 1]; ++a)
      for (int b = j.rows[row]; b < j.rows[row + 1]; ++b)
        if (std::max(j.cols[a], j.cols[b]) < columns)
          normal(j.cols[a], j.cols[b]) += j.values[a] * j.values[b];
  };
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    Eigen::Matrix3d of_point = Eigen::Matrix3d::Zero();
    std::map<int, Eigen::Vector3d> mixed;
    for (const int end = row + 2 * int(tracks_[t].observations.size()); row < end; ++row) {
      add();
      Eigen::Vector3d by_point = Eigen::Vector3d::Zero();
      for (int a = j.rows[row]; a < j.rows[row + 1]; ++a)
        if (j.cols[a] >= columns) by_point[j.cols[a] - columns - 3 * int(t)] = j.values[a];
      of_point += by_point * by_point.transpose();
      for (int a = j.rows[row]; a < j.rows[row + 1]; ++a)
        if (j.cols[a] < columns)
          mixed.try_emplace(j.cols[a], Eigen::Vector3d::Zero()).first->second +=
              j.values[a] * by_point;
    }
    const Eigen::Matrix3d inverse = of_point.inverse();
    for (const auto& [a, by_a] : mixed)
      for (const auto& [b, by_b] : mixed) normal(a, b) -= by_a.dot(inverse * by_b);
  }
  for (; row < j.num_rows; ++row) add();
  return normal;
}

std::vector<AdjustedLens> Bundle::deviations() {
  ceres::Problem problem;
  add_all(problem);
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = blocks_of_cameras(problem);
  int columns = 0;
  for (const double* block : evaluate.parameter_blocks)
    columns += problem.ParameterBlockTangentSize(block);
  for (glm::dvec3& point : points_) evaluate.parameter_blocks.push_back(&point.x);
  ceres::CRSMatrix jacobian;
  if (!problem.Evaluate(evaluate, nullptr, nullptr, nullptr, &jacobian)) return {};
  const Eigen::MatrixXd normal = reduced_normal(jacobian, columns);
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> solver(scale.asDiagonal() * normal * scale.asDiagonal());
  const int of_lenses = kLensSize * int(lenses_.size());
  const Eigen::MatrixXd inverse = solver.solve(Eigen::MatrixXd::Identity(columns, of_lenses));
  std::vector<AdjustedLens> lenses(lenses_.size());
  for (std::size_t l = 0; l < lenses.size(); ++l) {
    const auto sigma = [&](int i) {
      const int at = kLensSize * int(l) + i;
      return scale[at] * std::sqrt(inverse(at, at));
    };
    lenses[l].focal_sigma = sigma(0);
    lenses[l].principal_sigma = {sigma(1), sigma(2)};
    if (!std::isfinite(sigma(0) + sigma(1) + sigma(2))) return {};
  }
  return lenses;
}

void Bundle::write(Scene& scene, std::vector<AdjustedLens>& lenses) const {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const RadialLens& found = lenses_[lens_of_view_[i]];
    SourceView& view = scene.views[i];
    Intrinsics& k = view.camera.intrinsics;
    k.fx = k.fy = found[0], k.cx = found[1], k.cy = found[2];
    view.distortion = {DistortionModel::kBrown, {found[3]}};
    const Pose pose = pose_of(poses_[i]);
    view.camera.cam_from_world = {pose.rotation * world_.rotation,
                                  pose.rotation * world_.translation + pose.translation};
    AdjustedLens& lens = lenses[lens_of_view_[i]];
    ++lens.views;
    lens.intrinsics = k, lens.distortion = view.distortion;
  }
  scene.points.clear();
  for (const glm::dvec3& point : points_)
    scene.points.push_back(glm::transpose(world_.rotation) * (point - world_.translation));
}

}  // namespace

std::vector<AdjustedLens> adjust_lenses(Scene& scene, const std::vector<std::size_t>& lens_of_view,
                                        Progress& progress) {
  PHOTOHULL_CHECK_OP(lens_of_view.size(), ==, scene.views.size());
  Bundle bundle(scene, lens_of_view);
  if (!bundle.has_tracks() || !bundle.solve(progress)) return {};
  std::vector<AdjustedLens> lenses = bundle.deviations();
  if (!lenses.empty()) bundle.write(scene, lenses);
  return lenses;
}

}  // namespace photohull
