#include "cameras/gauge.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/median.h"

namespace photohull {
namespace {

constexpr double kOutlying = 2;  // times the views' median distance: where weights begin to fall

/// x -> scale * rotation * x + shift.
struct Similarity {
  double scale = 1;
  glm::dmat3 rotation{1.0};
  glm::dvec3 shift{0.0};

  glm::dvec3 operator()(const glm::dvec3& x) const { return scale * (rotation * x) + shift; }

  Camera moved(Camera camera) const {
    Pose& pose = camera.cam_from_world;
    pose.rotation = pose.rotation * glm::transpose(rotation);
    pose.translation = scale * pose.translation - pose.rotation * shift;
    return camera;
  }
};

std::vector<Camera> moved(std::span<const Camera> cameras, const Similarity& similarity) {
  std::vector<Camera> result;
  for (const Camera& camera : cameras) result.push_back(similarity.moved(camera));
  return result;
}

/// A turn by p[0..2], an angle-axis vector, and a scale of exp(p[6]), both about `middle`; then a
/// shift by p[3..5] sizes.
Similarity similarity_of(const double* p, const glm::dvec3& middle, double size) {
  double r[9];  // by columns
  ceres::AngleAxisToRotationMatrix(p, r);
  Similarity s;
  for (int i = 0; i < 9; ++i) s.rotation[i / 3][i % 3] = r[i];
  s.scale = std::exp(p[6]);
  s.shift = middle + size * glm::dvec3(p[3], p[4], p[5]) - s.scale * (s.rotation * middle);
  return s;
}

/// Pixels between where the given camera sees the moved points and where the refined one sees them,
/// so divided that the block's norm is their root mean square.
struct Appearance {
  const Camera& given;
  std::vector<glm::dvec2> seen;
  std::span<const glm::dvec3> points;
  glm::dvec3 middle;
  double size;

  bool operator()(const double* const parameters, double* residuals) const {
    const Similarity s = similarity_of(parameters, middle, size);
    const double share = 1 / std::sqrt(double(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto pixel = given.project(s(points[i]));
      if (!pixel) return false;
      const glm::dvec2 d = share * (*pixel - seen[i]);
      residuals[2 * i] = d.x, residuals[2 * i + 1] = d.y;
    }
    return true;
  }
};

double mean_distance(std::span<const glm::dvec3> points, const glm::dvec3& from) {
  double sum = 0;
  for (const glm::dvec3& p : points) sum += glm::distance(p, from);
  return sum / double(points.size());
}

}  // namespace

std::vector<Camera> with_world_moved(std::span<const Camera> cameras,
                                     std::span<const glm::dvec3> from,
                                     std::span<const glm::dvec3> to) {
  Eigen::Matrix3Xd a(3, from.size()), b(3, to.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (int k = 0; k < 3; ++k) a(k, long(i)) = from[i][k], b(k, long(i)) = to[i][k];
  const Eigen::Matrix4d fitted = Eigen::umeyama(a, b, true);
  Similarity s;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) s.rotation[j][i] = fitted(i, j);
    s.shift[i] = fitted(i, 3);
  }
  s.scale = std::cbrt(glm::determinant(s.rotation));
  s.rotation /= s.scale;
  return moved(cameras, s);
}

std::vector<Camera> with_world_as_given(std::span<const Camera> cameras,
                                        std::span<const Camera> given,
                                        std::span<const glm::dvec3> points,
                                        const glm::dvec3& middle) {
  const std::vector<Camera> as_they_are(cameras.begin(), cameras.end());
  if (points.empty()) return as_they_are;
  const double size = mean_distance(points, middle);
  std::array<double, 7> parameters{};
  std::vector<Appearance> blocks;
  std::vector<double> distances;
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    std::vector<glm::dvec2> seen;
    for (const glm::dvec3& p : points)
      if (const auto pixel = cameras[v].project(p)) seen.push_back(*pixel);
    if (seen.size() < points.size()) continue;
    Appearance block{given[v], std::move(seen), points, middle, size};
    std::vector<double> residuals(2 * points.size());
    if (!block(parameters.data(), residuals.data())) continue;
    double sum = 0;
    for (const double r : residuals) sum += r * r;
    distances.push_back(std::sqrt(sum));
    blocks.push_back(std::move(block));
  }
  const double width = kOutlying * median(distances);
  if (!(size > 0 && width > 0)) return as_they_are;
  ceres::Problem problem;
  for (const Appearance& block : blocks) {
    auto* cost = new ceres::NumericDiffCostFunction<Appearance, ceres::CENTRAL, ceres::DYNAMIC, 7>(
        new Appearance(block), ceres::TAKE_OWNERSHIP, int(2 * points.size()));
    problem.AddResidualBlock(cost, new ceres::CauchyLoss(width), parameters.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;  // the same result in every run
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return as_they_are;
  return moved(cameras, similarity_of(parameters.data(), middle, size));
}

}  // namespace photohull
