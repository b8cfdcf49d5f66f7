// Based on: M. Fischler and R. Bolles, "Random sample consensus", 1981 [Fischler81]; S. Umeyama,
// "Least-squares estimation of transformation parameters", 1991 [Umeyama91].
#include "cameras/rigid_motion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace photohull {
namespace {

constexpr long kMostSamples = 2'000'000;  // three of four hundred pairs agree in some of them
constexpr double kSure = 1e-4;            // chance that no sample was all right
constexpr int kRefits = 5;

using Sample = std::array<std::size_t, 3>;

std::vector<std::size_t> agreeing(std::span<const PointPair> pairs, const RigidMotion& motion) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (glm::distance(motion(pairs[i].from), pairs[i].to) <= pairs[i].tolerance) found.push_back(i);
  return found;
}

std::vector<PointPair> chosen(std::span<const PointPair> pairs,
                              const std::vector<std::size_t>& indices) {
  std::vector<PointPair> some;
  for (const std::size_t i : indices) some.push_back(pairs[i]);
  return some;
}

/// Are the triangle's sides alike in both worlds, and is it none that is as good as a line?
bool may_agree(std::span<const PointPair> pairs, const Sample& s) {
  double shortest = INFINITY, longest = 0, largest_tolerance = 0;
  for (int k = 0; k < 3; ++k) {
    const PointPair &a = pairs[s[std::size_t(k)]], &b = pairs[s[std::size_t((k + 1) % 3)]];
    const double before = glm::distance(a.from, b.from), after = glm::distance(a.to, b.to);
    if (!(std::abs(before - after) <= a.tolerance + b.tolerance)) return false;
    shortest = std::min(shortest, before), longest = std::max(longest, before);
    largest_tolerance = std::max(largest_tolerance, a.tolerance);
  }
  if (!(shortest > 2 * largest_tolerance)) return false;
  const glm::dvec3& from = pairs[s[0]].from;
  const double twice_area =
      glm::length(glm::cross(pairs[s[1]].from - from, pairs[s[2]].from - from));
  return twice_area > 0.1 * longest * longest && twice_area > 2 * largest_tolerance * longest;
}

/// Do places spread across a line by more than they may be off?
bool spread(std::span<const PointPair> pairs) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double tolerance = 0;
  const auto place = [](const PointPair& p) {
    return Eigen::Vector3d(p.from.x, p.from.y, p.from.z);
  };
  for (const PointPair& p : pairs) mean += place(p), tolerance += p.tolerance;
  const double count = double(pairs.size());
  mean /= count, tolerance /= count;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const PointPair& p : pairs)
    moments += (place(p) - mean) * (place(p) - mean).transpose() / count;
  // Ascending: the second one is the spread across the line that goes along the places.
  const Eigen::Vector3d values =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvalues();
  return std::sqrt(std::max(0.0, values[1])) > tolerance;
}

/// How many samples make it sure that one was right, when so many pairs agree.
double samples_needed(std::size_t agree, std::size_t all) {
  const double right = std::pow(double(agree) / double(all), 3);
  return right >= 1 ? 0 : std::log(kSure) / std::log1p(-right);
}

}  // namespace

RigidMotion RigidMotion::inverse() const {
  const glm::dmat3 back = glm::transpose(rotation);
  return {back, -(back * translation)};
}

Camera RigidMotion::moved(Camera camera) const {
  Pose& pose = camera.cam_from_world;
  pose.rotation = pose.rotation * glm::transpose(rotation);
  pose.translation -= pose.rotation * translation;
  return camera;
}

RigidMotion fit_motion(std::span<const PointPair> pairs) {
  Eigen::Matrix3Xd from(3, long(pairs.size())), to(3, long(pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (int k = 0; k < 3; ++k)
      from(k, long(i)) = pairs[i].from[k], to(k, long(i)) = pairs[i].to[k];
  const Eigen::Matrix4d fitted = Eigen::umeyama(from, to, false);
  RigidMotion motion;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) motion.rotation[j][i] = fitted(i, j);
    motion.translation[i] = fitted(i, 3);
  }
  return motion;
}

std::optional<AgreedMotion> find_motion(std::span<const PointPair> pairs, std::size_t fewest) {
  fewest = std::max<std::size_t>(3, fewest);
  if (pairs.size() < fewest) return std::nullopt;
  std::mt19937 random(24);
  AgreedMotion best;
  double needed = double(kMostSamples);
  for (long tried = 0; double(tried) < needed; ++tried) {
    Sample sample{};
    for (std::size_t& i : sample) i = random() % pairs.size();
    if (!may_agree(pairs, sample)) continue;
    const std::array three{pairs[sample[0]], pairs[sample[1]], pairs[sample[2]]};
    const RigidMotion motion = fit_motion(three);
    std::vector<std::size_t> found = agreeing(pairs, motion);
    if (found.size() <= best.agreeing.size()) continue;
    best = {motion, std::move(found)};
    needed = std::min(double(kMostSamples), samples_needed(best.agreeing.size(), pairs.size()));
  }
  for (int k = 0; k < kRefits && best.agreeing.size() >= fewest; ++k) {
    const RigidMotion motion = fit_motion(chosen(pairs, best.agreeing));
    std::vector<std::size_t> found = agreeing(pairs, motion);
    if (found.size() < best.agreeing.size()) break;
    best = {motion, std::move(found)};
  }
  if (best.agreeing.size() < fewest || !spread(chosen(pairs, best.agreeing))) return std::nullopt;
  return best;
}

}  // namespace photohull
