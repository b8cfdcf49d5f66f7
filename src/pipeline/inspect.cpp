#include "pipeline/inspect.h"

#include <algorithm>
#include <cmath>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "pipeline/checks.h"
#include "pipeline/memory.h"
#include "pipeline/plan.h"

namespace photohull::pipeline {
namespace {

constexpr double kDegrees = 57.29577951308232;
constexpr double kSmallestBaseline = 3;  // degrees: closer views tell little about depth
constexpr double kLargestBaseline = 50;  // degrees: farther views hardly correlate

void measure_angles(Inspection& out) {
  std::vector<glm::dvec3> rays;
  for (const SourceView& view : out.scene.views)
    rays.push_back(glm::normalize(view.camera.center() - out.scene.box->center()));
  std::vector<double> nearest;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    double least = 180;
    for (std::size_t j = 0; j < rays.size(); ++j) {
      if (i == j) continue;
      const double angle = kDegrees * std::acos(std::clamp(glm::dot(rays[i], rays[j]), -1.0, 1.0));
      least = std::min(least, angle);
      out.farthest_angle = std::max(out.farthest_angle, angle);
    }
    nearest.push_back(least);
  }
  std::nth_element(nearest.begin(), nearest.begin() + long(nearest.size() / 2), nearest.end());
  out.nearest_angle = nearest[nearest.size() / 2];
}

}  // namespace

Inspection inspect(const Scene& scene, const ReconstructOptions& options) {
  Inspection out;
  out.scene = scene;
  out.warnings = scene.warnings;
  if (!scene.box) return out;  // whoever looked for one says why
  check_cameras_outside(*scene.box, scene.box_source, scene.views);
  const auto box_warnings = check_box(*scene.box, scene.box_source, scene.views);
  out.warnings.insert(out.warnings.end(), box_warnings.begin(), box_warnings.end());
  measure_angles(out);
  std::vector<Camera> cameras;
  for (const SourceView& view : scene.views) cameras.push_back(view.camera);
  out.voxel_size = carving::pixel_footprint(*scene.box, cameras);
  out.memory_limit = options.max_memory ? *options.max_memory : default_max_memory();
  Plan plan = plan_job(options, scene, *scene.box, true, out.memory_limit);
  out.grid = plan.grid;
  out.scales = std::move(plan.scales);
  out.memory_bytes = plan.cost.bytes;
  out.cpu_seconds = plan.cost.cpu_seconds;
  if (out.memory_bytes > out.memory_limit)
    out.warnings.push_back(concat("a reconstruction would take more memory than it may (",
                                  memory_text(out.memory_limit),
                                  "; --max-memory): lower --resolution"));
  if (out.grid.voxel_size > carving::voxel_size_for(*scene.box, 2))
    out.warnings.push_back("the box is hardly larger than a pixel: check its units");
  if (out.nearest_angle < kSmallestBaseline)
    out.warnings.push_back("neighbouring views are nearly the same: depth will be uncertain");
  if (out.nearest_angle > kLargestBaseline)
    out.warnings.push_back(
        "neighbouring views are far apart: photo-consistency will find little; "
        "add views or use --method hull");
  return out;
}

}  // namespace photohull::pipeline
