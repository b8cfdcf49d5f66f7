// How the poses are to be read.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <set>

#include "cameras/diagnose_parts.h"
#include "cameras/triangulate.h"
#include "core/median.h"

namespace photohull {

Pose PoseReading::pose(const Pose& given) const {
  Pose pose = given;
  if (inverted) {
    pose.rotation = glm::transpose(given.rotation);
    pose.translation = -(pose.rotation * given.translation);
  }
  glm::dmat3 flip(1.0);
  for (int axis = 0; axis < 3; ++axis)
    if (flipped[std::size_t(axis)]) flip[axis][axis] = -1;
  return {flip * pose.rotation, flip * pose.translation};
}

namespace diagnosis {
namespace {

constexpr int kNeighbours = 2;  // views that each one is matched with, by every guess

Cameras reread(Cameras cameras, const PoseReading& reading) {
  for (Camera& camera : cameras) camera.cam_from_world = reading.pose(camera.cam_from_world);
  return cameras;
}

/// Distances of matches from their epipolar lines, in the matches' order; infinite where no point
/// in front of both cameras has such pixels.
std::vector<double> match_residuals(const Cameras& cameras,
                                    const std::vector<PairMatches>& matches) {
  std::vector<std::vector<double>> by_pair(matches.size());
  tbb::parallel_for(std::size_t(0), matches.size(), [&](std::size_t i) {
    const PairMatches& m = matches[i];
    for (std::size_t k = 0; k < std::min(kMostOfPair, m.pixels.size()); ++k) {
      const auto& [p, q] = m.pixels[k];
      const bool in_front = triangulate(cameras, {{{m.view_a, p}, {m.view_b, q}}}).has_value();
      const double r = epipolar_residual(cameras, m.view_a, m.view_b, p, q);
      by_pair[i].push_back(in_front && std::isfinite(r) ? r : INFINITY);
    }
  });
  std::vector<double> all;
  for (const auto& part : by_pair) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

std::vector<std::pair<int, int>> pairs_to_match(const Cameras& cameras) {
  std::set<std::pair<int, int>> pairs;
  const int n = int(cameras.size());
  const auto add = [&](int i, int j) {
    if (i != j) pairs.emplace(std::min(i, j), std::max(i, j));
  };
  for (const bool inverted : {false, true}) {
    const Cameras read = reread(cameras, {.inverted = inverted});
    for (int i = 0; i < n; ++i) {
      std::vector<std::pair<double, int>> others;
      for (int j = 0; j < n; ++j)
        if (j != i) others.emplace_back(-glm::dot(read[i].forward(), read[j].forward()), j);
      std::sort(others.begin(), others.end());
      for (int k = 0; k < std::min(kNeighbours, int(others.size())); ++k) add(i, others[k].second);
    }
  }
  for (int i = 0; i + 1 < n; ++i) add(i, i + 1);
  return {pairs.begin(), pairs.end()};
}

std::vector<PoseReading> try_readings(const Cameras& given,
                                      const std::vector<PairMatches>& matches) {
  constexpr double kLeastTolerance = 0.5, kMostTolerance = 8;  // pixels
  std::vector<PoseReading> readings;
  std::vector<std::vector<double>> residuals;
  double best = INFINITY;
  for (const bool inverted : {false, true})
    for (int flips = 0; flips < 8; ++flips) {
      PoseReading r{inverted, {(flips & 1) != 0, (flips & 2) != 0, (flips & 4) != 0}};
      residuals.push_back(match_residuals(reread(given, r), matches));
      r.residual = median(residuals.back());
      best = std::min(best, r.residual);
      readings.push_back(r);
    }
  const double tolerance = std::clamp(4 * best, kLeastTolerance, kMostTolerance);
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings[i].explained = double(std::count_if(residuals[i].begin(), residuals[i].end(),
                                                 [&](double r) { return r <= tolerance; })) /
                            double(residuals[i].size());
  std::stable_sort(readings.begin(), readings.end(),
                   [](const auto& a, const auto& b) { return a.explained > b.explained; });
  return readings;
}

}  // namespace diagnosis
}  // namespace photohull
