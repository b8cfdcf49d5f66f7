// Based on: B. Triggs et al., "Bundle adjustment: a modern synthesis", 1999 [Triggs99].
#include "cameras/refine_motion.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <cmath>
#include <limits>

#include "cameras/motion_jackknife.h"
#include "cameras/triangulate.h"
#include "core/median.h"

namespace photohull {
namespace {

constexpr std::size_t kFewest = 8;  // tracks
constexpr int kRounds = 3;
constexpr double kTail = 2;                 // pixels' deviations where the loss flattens
constexpr double kLeastNoise = 0.02;        // pixels
constexpr double kOutlying = 4;             // deviations, root mean square of a track
constexpr double kRayleighMedian = 1.1774;  // of a distance, in deviations of a coordinate

template <typename T>
bool project_residual(const Camera& camera, const T* place, const glm::dvec2& pixel, double weight,
                      T* residual) {
  const Pose& pose = camera.cam_from_world;
  T p[3];
  for (int i = 0; i < 3; ++i)
    p[i] = pose.rotation[0][i] * place[0] + pose.rotation[1][i] * place[1] +
           pose.rotation[2][i] * place[2] + pose.translation[i];
  if (!(p[2] > T(0))) return false;
  const Intrinsics& k = camera.intrinsics;
  residual[0] = weight * ((k.fx * p[0] + k.skew * p[1]) / p[2] + k.cx - pixel.x);
  residual[1] = weight * (k.fy * p[1] / p[2] + k.cy - pixel.y);
  return true;
}

struct FixedResidual {
  const Camera& camera;
  glm::dvec2 pixel;
  double weight;

  template <typename T>
  bool operator()(const T* point, T* residual) const {
    return project_residual(camera, point, pixel, weight, residual);
  }
};

/// The motion is that of the start, then a turn (angle-axis) about the middle and a shift.
struct MovedResidual {
  const Camera& camera;
  glm::dvec2 pixel;
  double weight;
  const RigidMotion& back;  ///< of the start: to the moved world
  glm::dvec3 middle;

  template <typename T>
  bool operator()(const T* motion, const T* point, T* residual) const {
    const T turn[3] = {-motion[0], -motion[1], -motion[2]};
    T from_middle[3], turned[3], place[3];
    for (int i = 0; i < 3; ++i) from_middle[i] = point[i] - motion[3 + i] - middle[i];
    ceres::AngleAxisRotatePoint(turn, from_middle, turned);
    for (int i = 0; i < 3; ++i) turned[i] += middle[i];
    for (int i = 0; i < 3; ++i)
      place[i] = back.rotation[0][i] * turned[0] + back.rotation[1][i] * turned[1] +
                 back.rotation[2][i] * turned[2] + back.translation[i];
    return project_residual(camera, place, pixel, weight, residual);
  }
};

class MotionFit {
 public:
  explicit MotionFit(const MotionProblem& given) : given_(given), motion_(given.start) {
    for (const Track& track : given.tracks)
      if (crosses(track)) tracks_.push_back(track);
  }

  std::optional<RefinedMotion> run() {
    for (int round = 0; round < kRounds; ++round) {
      if (!place_points() || !fit(round + 1 == kRounds)) return std::nullopt;
      if (round + 1 < kRounds) drop_outliers();
    }
    result_.motion = motion_;
    result_.points = points_;
    result_.seam = seam();
    return result_;
  }

 private:
  bool is_moved(const Observation& o) const { return std::size_t(o.view) >= given_.first_moved; }
  bool crosses(const Track& track) const {
    bool moved = false, fixed = false;
    for (const Observation& o : track.observations) (is_moved(o) ? moved : fixed) = true;
    return moved && fixed;
  }

  /// All in the world that stays, by the motion as it is known.
  std::vector<Camera> cameras() const {
    std::vector<Camera> all(given_.cameras.begin(), given_.cameras.end());
    for (std::size_t i = given_.first_moved; i < all.size(); ++i) all[i] = motion_.moved(all[i]);
    return all;
  }

  /// Tracks that have no point go; false where too few are left.
  bool place_points() {
    const std::vector<Camera> all = cameras();
    std::vector<Track> kept;
    points_.clear();
    for (Track& track : tracks_) {
      const auto point = triangulate(all, track);
      if (!point) continue;
      points_.push_back(*point);
      kept.push_back(std::move(track));
    }
    tracks_ = std::move(kept);
    return tracks_.size() >= kFewest;
  }

  double deviation() const {
    const std::vector<Camera> all = cameras();
    std::vector<double> distances;
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      // A point takes three of the coordinates' degrees of freedom.
      const double n = 2 * double(tracks_[t].observations.size());
      distances.push_back(reprojection_rms(all, tracks_[t], points_[t]) * std::sqrt(n / (n - 3)));
    }
    // Root mean square over a track's pixels: of two coordinates each.
    return std::max(kLeastNoise, median(distances) / std::sqrt(2.0));
  }

  bool fit(bool last) {
    const double noise = deviation();
    const RigidMotion start = motion_, back = start.inverse();
    std::array<double, 6> unknowns{};
    ceres::Problem problem;
    auto* const loss = new ceres::CauchyLoss(kTail);
    blocks_.clear();
    for (std::size_t t = 0; t < tracks_.size(); ++t)
      for (const Observation& o : tracks_[t].observations) {
        const Camera& camera = given_.cameras[std::size_t(o.view)];
        if (is_moved(o))
          blocks_.push_back(problem.AddResidualBlock(
              new ceres::AutoDiffCostFunction<MovedResidual, 2, 6, 3>(
                  new MovedResidual{camera, o.pixel, 1 / noise, back, given_.middle}),
              loss, unknowns.data(), &points_[t].x));
        else
          blocks_.push_back(
              problem.AddResidualBlock(new ceres::AutoDiffCostFunction<FixedResidual, 2, 3>(
                                           new FixedResidual{camera, o.pixel, 1 / noise}),
                                       loss, &points_[t].x));
      }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (glm::dvec3& point : points_)
      options.linear_solver_ordering->AddElementToGroup(&point.x, 0);
    options.linear_solver_ordering->AddElementToGroup(unknowns.data(), 1);
    options.max_num_iterations = 50;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;  // sums in the same order on every machine
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) return false;
    apply(unknowns, start);
    if (last) result_.determined = find_covariance(problem);
    return true;
  }

  void apply(const std::array<double, 6>& unknowns, const RigidMotion& start) {
    double r[9];  // by columns
    ceres::AngleAxisToRotationMatrix(unknowns.data(), r);
    glm::dmat3 turn(1.0);
    for (int i = 0; i < 9; ++i) turn[i / 3][i % 3] = r[i];
    const glm::dvec3 shift(unknowns[3], unknowns[4], unknowns[5]);
    motion_.rotation = turn * start.rotation;
    motion_.translation = turn * (start.translation - given_.middle) + given_.middle + shift;
  }

  bool find_covariance(ceres::Problem& problem) {
    const auto found = jackknife(linear_pixels(problem));
    if (found) result_.covariance = *found;
    return found.has_value();
  }

  std::vector<std::vector<LinearPixel>> linear_pixels(ceres::Problem& problem) const {
    std::vector<std::vector<LinearPixel>> all(tracks_.size());
    auto block = blocks_.begin();
    for (std::size_t t = 0; t < tracks_.size(); ++t)
      for (const Observation& o : tracks_[t].observations) {
        LinearPixel& pixel = all[t].emplace_back();
        pixel.view = o.view;
        pixel.moved = is_moved(o);
        double cost = 0;
        double* by_point[] = {pixel.by_point[0].data()};
        double* by_both[] = {pixel.by_motion[0].data(), pixel.by_point[0].data()};
        problem.EvaluateResidualBlock(*block++, true, &cost, pixel.residual.data(),
                                      pixel.moved ? by_both : by_point);
      }
    return all;
  }

  void drop_outliers() {
    const double limit = kOutlying * std::sqrt(2.0) * deviation();
    const std::vector<Camera> all = cameras();
    std::vector<Track> kept;
    for (std::size_t t = 0; t < tracks_.size(); ++t)
      if (reprojection_rms(all, tracks_[t], points_[t]) <= limit)
        kept.push_back(std::move(tracks_[t]));
    tracks_ = std::move(kept);
  }

  double seam() const {
    const std::vector<Camera> all = cameras();
    std::vector<double> distances;
    for (const Track& track : tracks_)
      for (const bool moved : {false, true}) {
        Track own, other;
        for (const Observation& o : track.observations)
          (is_moved(o) == moved ? own : other).observations.push_back(o);
        if (own.observations.size() < 2) continue;
        const auto point = triangulate(all, own);
        if (point) distances.push_back(reprojection_rms(all, other, *point));
      }
    return distances.empty() ? std::numeric_limits<double>::quiet_NaN() : median(distances);
  }

  const MotionProblem& given_;
  RigidMotion motion_;
  std::vector<Track> tracks_;
  std::vector<glm::dvec3> points_;
  std::vector<ceres::ResidualBlockId> blocks_;  ///< of the last fit, in the tracks' order
  RefinedMotion result_;
};

}  // namespace

std::optional<RefinedMotion> refine_motion(const MotionProblem& problem) {
  return MotionFit(problem).run();
}

double deviation_at(const RefinedMotion& refined, const glm::dvec3& middle,
                    const glm::dvec3& point) {
  if (!refined.determined) return std::numeric_limits<double>::infinity();
  const glm::dvec3 x = point - middle;
  // The point's place by the six unknowns: turn x x, and the shift.
  const double by[3][6] = {
      {0, x.z, -x.y, 1, 0, 0}, {-x.z, 0, x.x, 0, 1, 0}, {x.y, -x.x, 0, 0, 0, 1}};
  double sum = 0;
  for (const auto& row : by)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        sum += row[i] * row[j] * refined.covariance[std::size_t(i)][std::size_t(j)];
  return std::sqrt(std::max(0.0, sum / 3));
}

}  // namespace photohull
