#include "pipeline/inspect.h"

#include <algorithm>
#include <cmath>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "core/option_word.h"
#include "pipeline/checks.h"
#include "pipeline/memory.h"
#include "pipeline/methods/method.h"
#include "pipeline/plan.h"
#include "pipeline/read_scene.h"

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

/// Everything about the job; throws as reconstruct would.
void look_ahead(const Scene& scene, const ReconstructOptions& options, io::MaskSource source,
                Inspection& out) {
  const std::size_t within = cameras_within(*scene.box, scene.views);
  const bool masks = source != io::MaskSource::kNone &&
                     std::any_of(scene.views.begin(), scene.views.end(),
                                 [](const SourceView& view) { return !view.mask.empty(); });
  if (masks || !method_of(options).needs_no_silhouettes)
    check_cameras_outside(*scene.box, scene.box_source, scene.views);
  if (within > 0)
    out.warnings.push_back(concat(within, " of ", scene.views.size(),
                                  " cameras stand inside the box: it is taken for a room, and "
                                  "reconstructed without silhouettes"));
  const auto box_warnings = check_box(*scene.box, scene.box_source, scene.views);
  out.warnings.insert(out.warnings.end(), box_warnings.begin(), box_warnings.end());
  if (const auto why = hopeless_setup(*scene.box, scene.box_source, scene.views))
    out.warnings.push_back(*why);
  measure_angles(out);
  std::vector<Camera> cameras;
  for (const SourceView& view : scene.views) cameras.push_back(view.camera);
  out.voxel_size = carving::pixel_footprint(*scene.box, cameras);
  out.memory_limit = memory_limit(options);
  Plan plan = plan_job({options, source}, scene, *scene.box, true, out.memory_limit);
  out.silhouettes = plan.silhouettes;
  out.grid = plan.grid;
  out.matched = plan.held_bytes > 0 ? std::move(plan.wanted) : plan.scales;
  out.scales = std::move(plan.scales);
  out.memory_bytes = plan.cost.bytes;
  out.cpu_seconds = plan.cost.cpu_seconds;
  if (out.memory_bytes > out.memory_limit)
    out.warnings.push_back(
        concat("a reconstruction would take more memory than it may (",
               memory_text(out.memory_limit), "; ", option_word("max_memory"), "): ",
               method_of(options).in_parts ? "it would be made in parts, where these fit"
                                           : concat("lower ", option_word("resolution"))));
  if (out.grid.voxel_size > carving::voxel_size_for(*scene.box, 2))
    out.warnings.push_back("the box is hardly larger than a pixel: check its units");
  if (out.nearest_angle < kSmallestBaseline && within == 0)
    out.warnings.push_back("neighbouring views are nearly the same: depth will be uncertain");
  if (out.nearest_angle > kLargestBaseline && within == 0)
    out.warnings.push_back(concat(
        "neighbouring views are far apart: photo-consistency will find little; add views or use ",
        option_word("method", "hull")));
}

}  // namespace

Inspection inspect(const Scene& scene, const ReconstructOptions& options, io::MaskSource masks) {
  Inspection out;
  out.scene = scene;
  out.warnings = scene.warnings;
  out.extents = measure_extents(scene);
  try {
    if (scene.box) look_ahead(scene, options, masks, out);
  } catch (const UsageError&) {
    throw;
  } catch (const Error&) {
    out.failure = std::current_exception();
  }
  if (!scene.box || out.failure) out.suggested_box = suggest_box(scene);
  return out;
}

}  // namespace photohull::pipeline
