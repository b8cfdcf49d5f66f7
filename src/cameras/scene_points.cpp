#include "cameras/scene_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "cameras/feature_tracks.h"
#include "cameras/triangulate.h"

namespace photohull {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kFeatures = 2000;                   // a view
constexpr double kEpipolar = 4;                   // pixels
constexpr double kLargestResidual = 2;            // pixels, root mean square
constexpr double kSmallestAngle = 2;              // degrees between two of the rays
constexpr double kLargestTurn = 60;               // degrees between the axes of neighbours
constexpr int kRanks[] = {0, 1, 2, 3, 5, 8, 12};  // of the neighbours by distance: gaps grow

/// Pairs of views that may show the same, ascending.
std::vector<std::pair<int, int>> neighbours(std::span<const PreparedView> views) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < int(views.size()); ++i) {
    const Camera& camera = views[std::size_t(i)].camera;
    std::vector<std::pair<double, int>> others;
    for (int j = 0; j < int(views.size()); ++j) {
      const Camera& other = views[std::size_t(j)].camera;
      if (j != i && glm::dot(camera.forward(), other.forward()) > std::cos(kLargestTurn * kDegree))
        others.emplace_back(glm::distance(camera.center(), other.center()), j);
    }
    std::sort(others.begin(), others.end());
    for (const int rank : kRanks)
      if (rank < int(others.size()))
        pairs.emplace_back(std::minmax(i, others[std::size_t(rank)].second));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// Do two of the rays to the point differ enough?
bool is_sure(std::span<const Camera> cameras, const Track& track, const glm::dvec3& point) {
  const double most = std::cos(kSmallestAngle * kDegree);
  const auto& o = track.observations;
  for (std::size_t i = 0; i < o.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const glm::dvec3 a = cameras[std::size_t(o[i].view)].center() - point,
                       b = cameras[std::size_t(o[j].view)].center() - point;
      if (glm::dot(glm::normalize(a), glm::normalize(b)) < most) return true;
    }
  return false;
}

}  // namespace

std::vector<ScenePoint> find_scene_points(std::span<const PreparedView> views, Progress& progress) {
  TrackOptions options;
  options.features = kFeatures;
  options.epipolar = kEpipolar;
  options.pairs = neighbours(views);
  std::vector<Camera> cameras;
  for (const PreparedView& view : views) cameras.push_back(view.camera);
  std::vector<ScenePoint> points;
  for (const Track& track : find_tracks(views, options, progress)) {
    const auto point = triangulate(cameras, track);
    if (!point || !(reprojection_rms(cameras, track, *point) < kLargestResidual) ||
        !is_sure(cameras, track, *point))
      continue;
    ScenePoint found{*point, {}};
    for (const Observation& o : track.observations) found.views.push_back(o.view);
    std::sort(found.views.begin(), found.views.end());
    points.push_back(std::move(found));
  }
  return points;
}

}  // namespace photohull
