// Based on: B. Triggs et al., "Bundle adjustment: a modern synthesis", 1999 [Triggs99].
#include "cameras/bundle.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Geometry>
#include <memory>

namespace photohull {
namespace {

// Steps of one adjustment, and the share of the cost by which the last one lowers it. The next
// adjustment finds outliers and tangents anew, so the first few steps are what it needs of this
// one, unless cameras are far from where they belong: beyond kFar pixels of residuals.
constexpr double kFar = 1;
constexpr int kIterations = 12, kIterationsFromFar = 30;
constexpr double kSettled = 1e-5, kSettledFromFar = 1e-7;

/// A camera's change: a turn about the object's middle and a move, both in its own frame, in units
/// that move the object by about a pixel each.
struct Motion {
  glm::dvec3 middle{0.0};  ///< of the object, in the camera's frame
  double turn = 1;         ///< radians a unit
  double move = 1;         ///< world units a unit
  Camera camera;

  Motion(const Camera& c, const glm::dvec3& world) : middle(c.to_camera(world)), camera(c) {
    const double depth = std::max(std::abs(middle.z), 1e-9);
    turn = 4 / camera.intrinsics.fx;
    move = depth / camera.intrinsics.fx;
  }

  template <typename T>
  void apply(const T* unit, const T* point, T* result) const {
    const T turns[3] = {unit[0] * turn, unit[1] * turn, unit[2] * turn};
    const T arm[3] = {point[0] - middle.x, point[1] - middle.y, point[2] - middle.z};
    ceres::AngleAxisRotatePoint(turns, arm, result);
    for (int i = 0; i < 3; ++i) result[i] += middle[i] + unit[3 + i] * move;
  }

  Camera moved(const double* unit) const {
    Camera result = camera;
    const glm::dvec3 turns = turn * glm::dvec3(unit[0], unit[1], unit[2]);
    double rotation[9];
    ceres::AngleAxisToRotationMatrix(&turns.x, rotation);  // by columns, as glm
    glm::dmat3 r;
    for (int i = 0; i < 9; ++i) r[i / 3][i % 3] = rotation[i];
    Pose& pose = result.cam_from_world;
    pose.rotation = r * pose.rotation;
    pose.translation =
        r * (pose.translation - middle) + middle + move * glm::dvec3(unit[3], unit[4], unit[5]);
    return result;
  }
};

/// Focal factor's logarithm and principal point's offset in units of a pixel or so.
struct Shared {
  static constexpr double kFocal = 1e-3;

  template <typename T>
  static T focal(const T* shared) {
    using std::exp;
    return exp(shared[0] * kFocal);
  }
};

struct TrackResidual {
  const Motion& motion;
  glm::dvec2 pixel;
  double weight;

  template <typename T>
  bool operator()(const T* pose, const T* point, const T* shared, T* residual) const {
    const Pose& base = motion.camera.cam_from_world;
    T start[3], p[3];
    for (int i = 0; i < 3; ++i)
      start[i] = point[0] * base.rotation[0][i] + point[1] * base.rotation[1][i] +
                 point[2] * base.rotation[2][i] + base.translation[i];
    motion.apply(pose, start, p);
    if (!(p[2] > 0.0)) return false;
    const Intrinsics& k = motion.camera.intrinsics;
    const T f = Shared::focal(shared), x = p[0] / p[2], y = p[1] / p[2];
    residual[0] = weight * (f * (k.fx * x + k.skew * y) + k.cx + shared[1] - pixel.x);
    residual[1] = weight * (f * k.fy * y + k.cy + shared[2] - pixel.y);
    return true;
  }
};

/// Distances of the tangents' pixels from each other's epipolar lines.
struct TangentResidual {
  const Motion &a, &b;
  FrontierPair pair;
  double weight;

  template <typename T>
  using V = Eigen::Matrix<T, 3, 1>;

  /// Ray of a pixel in the camera's own frame as it was given, and the camera's centre, both
  /// brought into the world.
  template <typename T>
  static void look(const Motion& m, const T* unit, const T* shared, const glm::dvec2& pixel,
                   V<T>& center, V<T>& ray, Eigen::Matrix<T, 3, 3>& world_from_cam) {
    const Intrinsics& k = m.camera.intrinsics;
    const T f = Shared::focal(shared);
    const T y = (pixel.y - k.cy - shared[2]) / (f * k.fy);
    const T x = (pixel.x - k.cx - shared[1] - f * k.skew * y) / (f * k.fx);
    const T turns[3] = {unit[0] * m.turn, unit[1] * m.turn, unit[2] * m.turn};
    T rotation[9];
    ceres::AngleAxisToRotationMatrix(turns, rotation);
    const Eigen::Map<const Eigen::Matrix<T, 3, 3>> turn(rotation);
    Eigen::Matrix<T, 3, 3> base;
    V<T> middle, shift;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) base(i, j) = T(m.camera.cam_from_world.rotation[j][i]);
      middle[i] = T(m.middle[i]);
      shift[i] = turn(i, 0) * (m.camera.cam_from_world.translation[0] - m.middle[0]) +
                 turn(i, 1) * (m.camera.cam_from_world.translation[1] - m.middle[1]) +
                 turn(i, 2) * (m.camera.cam_from_world.translation[2] - m.middle[2]) + m.middle[i] +
                 unit[3 + i] * m.move;
    }
    world_from_cam = (turn * base).transpose();
    center = -(world_from_cam * shift);
    ray = world_from_cam * V<T>(x, y, T(1));
  }

  /// Distance in pixels, to first order, of a pixel from a plane through its camera.
  template <typename T>
  static T distance(const Motion& m, const V<T>& plane, const V<T>& ray,
                    const Eigen::Matrix<T, 3, 3>& world_from_cam, const T& f) {
    using std::sqrt;
    const V<T> n = world_from_cam.transpose() * plane;
    const T gx = n[0] / (f * m.camera.intrinsics.fx);
    const T gy = (n[1] - n[0] * m.camera.intrinsics.skew / m.camera.intrinsics.fx) /
                 (f * m.camera.intrinsics.fy);
    return plane.dot(ray) / sqrt(gx * gx + gy * gy + 1e-300);
  }

  template <typename T>
  bool operator()(const T* pose_a, const T* pose_b, const T* shared, T* residual) const {
    V<T> center_a, center_b, ray_a, ray_b;
    Eigen::Matrix<T, 3, 3> from_a, from_b;
    look(a, pose_a, shared, pair.pixel_a, center_a, ray_a, from_a);
    look(b, pose_b, shared, pair.pixel_b, center_b, ray_b, from_b);
    const V<T> base = center_b - center_a;
    const T f = Shared::focal(shared);
    residual[0] = weight * distance<T>(a, V<T>(base.cross(ray_b)), ray_a, from_a, f);
    residual[1] = weight * distance<T>(b, V<T>(base.cross(ray_a)), ray_b, from_b, f);
    return true;
  }
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

using Poses = std::vector<std::array<double, 6>>;

/// Where the cameras start, as motions from the given poses. The motions take the present
/// intrinsics.
Poses start_poses(std::span<const Camera> start, std::vector<Motion>& motions) {
  Poses poses(motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    Motion& m = motions[i];
    m.camera.intrinsics = start[i].intrinsics;
    const glm::dmat3 r =
        start[i].cam_from_world.rotation * glm::transpose(m.camera.cam_from_world.rotation);
    double columns[9];
    for (int k = 0; k < 9; ++k) columns[k] = r[k / 3][k % 3];
    ceres::RotationMatrixToAngleAxis(columns, poses[i].data());
    const glm::dvec3 shift = start[i].cam_from_world.translation -
                             (r * (m.camera.cam_from_world.translation - m.middle) + m.middle);
    for (int k = 0; k < 3; ++k) {
      poses[i][k] /= m.turn;
      poses[i][3 + k] = shift[k] / m.move;
    }
  }
  return poses;
}

/// What an adjustment moves: its cameras and points, and what all cameras share.
struct Unknowns {
  std::vector<Motion> motions;
  Poses poses;
  std::vector<glm::dvec3> points;
  std::array<double, 3>& shared;
};

void add_residuals(const BundleInput& input, Unknowns& u, ceres::Problem& problem) {
  constexpr double kTail = 3;
  for (std::size_t t = 0; t < u.points.size(); ++t)
    for (const Observation& o : input.tracks[t].observations)
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<TrackResidual, 2, 6, 3, 3>(
              new TrackResidual{u.motions[o.view], o.pixel, 1 / input.track_sigma}),
          new ceres::CauchyLoss(kTail), u.poses[o.view].data(), &u.points[t].x, u.shared.data());
  for (const FrontierPair& pair : input.tangents)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<TangentResidual, 2, 6, 6, 3>(new TangentResidual{
            u.motions[pair.view_a], u.motions[pair.view_b], pair, 1 / input.tangent_sigma}),
        new ceres::CauchyLoss(kTail), u.poses[pair.view_a].data(), u.poses[pair.view_b].data(),
        u.shared.data());
  for (auto& pose : u.poses)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PriorResidual, 6, 6>(new PriorResidual{input.prior_sigma}),
        nullptr, pose.data());
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
  shared = {0, 0, 0};
  Unknowns u{{}, {}, input.points, shared};
  for (const Camera& camera : prior) u.motions.emplace_back(camera, input.middle);
  u.poses = start_poses(start, u.motions);
  ceres::Problem problem;
  add_residuals(input, u, problem);
  hold(input, u, problem);
  ceres::Solver::Options options;
  order_unknowns(u, problem, options);
  // Where most views are held, residuals do not tell how far the others are.
  const bool far = !input.held.empty() || std::max(input.track_sigma, input.tangent_sigma) > kFar;
  options.max_num_iterations = far ? kIterationsFromFar : kIterations;
  options.function_tolerance = far ? kSettledFromFar : kSettled;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;  // sums in the same order on every machine
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::vector<Camera> result(start.begin(), start.end());
  if (!summary.IsSolutionUsable()) {
    shared = {1, 0, 0};
    return result;
  }
  const double focal = Shared::focal(shared.data());
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (std::find(input.held.begin(), input.held.end(), int(i)) == input.held.end())
      result[i] = u.motions[i].moved(u.poses[i].data());
    Intrinsics& k = result[i].intrinsics;
    k.fx *= focal, k.fy *= focal, k.skew *= focal;
    k.cx += shared[1], k.cy += shared[2];
  }
  shared[0] = focal;
  return result;
}

}  // namespace photohull
