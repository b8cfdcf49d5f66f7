// Whether the box is where the cameras look.
#include <algorithm>

#include "cameras/diagnose_parts.h"
#include "cameras/triangulate.h"
#include "core/median.h"

namespace photohull::diagnosis {
namespace {

bool on_an_image(const Camera& camera, const Box& box) {
  constexpr int kProbes = 6;  // along each side
  for (int i = 0; i < kProbes * kProbes * kProbes; ++i) {
    const glm::ivec3 at(i % kProbes, i / kProbes % kProbes, i / kProbes / kProbes);
    const auto pixel =
        camera.project(box.min + box.size() * (glm::dvec3(at) / double(kProbes - 1)));
    if (pixel && camera.on_image(*pixel)) return true;
  }
  return false;
}

}  // namespace

BoxFit fit_box(const Cameras& cameras, const std::vector<PairMatches>& matches, const Box& box) {
  constexpr double kLargestResidual = 4;  // pixels
  BoxFit fit;
  fit.diagonal = box.diagonal();
  std::vector<double> distances;
  for (const Camera& camera : cameras) {
    fit.seen_by += on_an_image(camera, box);
    fit.cameras_inside += box.contains(camera.center());
    distances.push_back(glm::distance(camera.center(), box.center()));
  }
  fit.distance = median(distances);
  std::vector<glm::dvec3> points;
  for (const PairMatches& m : matches)
    for (std::size_t k = 0; k < std::min(kMostOfPair, m.pixels.size()); ++k) {
      const auto& [p, q] = m.pixels[k];
      if (!(epipolar_residual(cameras, m.view_a, m.view_b, p, q) < kLargestResidual)) continue;
      if (const auto point = triangulate(cameras, {{{m.view_a, p}, {m.view_b, q}}}))
        points.push_back(*point);
    }
  fit.points = int(points.size());
  if (points.empty()) return fit;
  Box around;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const glm::dvec3& p : points) values.push_back(p[axis]);
    std::sort(values.begin(), values.end());
    around.min[axis] = values[values.size() / 20];
    around.max[axis] = values[values.size() - 1 - values.size() / 20];
  }
  fit.points_inside = double(std::count_if(points.begin(), points.end(),
                                           [&](const glm::dvec3& p) { return box.contains(p); })) /
                      double(points.size());
  fit.points_diagonal = around.diagonal();
  distances.clear();
  for (const Camera& camera : cameras)
    distances.push_back(glm::distance(camera.center(), around.center()));
  fit.points_distance = median(distances);
  return fit;
}

}  // namespace photohull::diagnosis
