#include "pipeline/extents.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/median.h"
#include "pipeline/find_box.h"

namespace photohull::pipeline {
namespace {

constexpr std::size_t kEnoughPoints = 100;  // for find_box to go by them
constexpr double kOfCone =
    0.6;  // the cube's half side, of what a camera's image holds on each side

/// Half of what each camera's image holds at a place, across its narrower side; the median.
double half_seen(const std::vector<Camera>& cameras, const glm::dvec3& place) {
  std::vector<double> halves;
  for (const Camera& c : cameras) {
    const Intrinsics& k = c.intrinsics;
    const double distance = glm::distance(c.center(), place);
    halves.push_back(distance * std::min(0.5 * k.width / k.fx, 0.5 * k.height / k.fy));
  }
  return median(halves);
}

}  // namespace

Extents measure_extents(const Scene& scene) {
  Extents out;
  const glm::dvec3 first = scene.views.empty() ? glm::dvec3(0) : scene.views[0].camera.center();
  out.cameras = {first, first};
  for (const SourceView& view : scene.views) {
    const glm::dvec3 c = view.camera.center();
    out.cameras = {glm::min(out.cameras.min, c), glm::max(out.cameras.max, c)};
  }
  if (scene.points.empty()) return out;
  for (const double low : {0.0, 0.01, 0.05, 0.25}) out.points.push_back({low, 1 - low, {}});
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const glm::dvec3& p : scene.points) values.push_back(p[axis]);
    std::sort(values.begin(), values.end());
    const auto at = [&](double q) {
      return values[std::size_t(std::lround(q * double(values.size() - 1)))];
    };
    for (Extents::Share& s : out.points) s.box.min[axis] = at(s.low), s.box.max[axis] = at(s.high);
  }
  return out;
}

std::optional<Box> suggest_box(const Scene& scene) {
  std::vector<PreparedView> views;
  std::vector<Camera> cameras;
  for (const SourceView& view : scene.views) {
    views.push_back({view.name, view.camera, {}, {}});
    cameras.push_back(view.camera);
  }
  if (scene.points.size() >= kEnoughPoints) {
    BoxEvidence evidence{views, false};
    for (const glm::dvec3& p : scene.points) evidence.points.push_back({p, {}});
    Progress silent;
    try {
      return find_box(evidence, silent).box;
    } catch (const Error&) {
      // The cameras may still tell.
    }
  }
  const AxesMeeting meeting = meeting_of_axes(cameras);
  if (!meeting.looks_inwards) return std::nullopt;
  const glm::dvec3 half(kOfCone * half_seen(cameras, meeting.point));
  const Box cube{meeting.point - half, meeting.point + half};
  for (const Camera& c : cameras)
    if (cube.contains(c.center())) return std::nullopt;
  return cube;
}

}  // namespace photohull::pipeline
