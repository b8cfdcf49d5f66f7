#include "pipeline/inspect.h"

#include <algorithm>
#include <cmath>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "pipeline/checks.h"
#include "pipeline/reconstruct.h"

namespace photohull::pipeline {
namespace {

constexpr double kDegrees = 57.29577951308232;
// Within a factor of two of the CPU seconds, and a third of the memory, that `photohull reconstruct
// --json` reported for templeRing, dinoRing and armadillo on a software rasterizer: how much
// surface a box holds is not known before. They only feed the estimate.
constexpr double kSecondsPerPixel = 3.5e-8;
constexpr double kSecondsPerSurfaceVoxel = 3.5e-5;
constexpr std::int64_t kBaseMemory = 280 << 20;  // libraries and the driver's compiler
constexpr double kSmallestBaseline = 3;          // degrees: closer views tell little about depth
constexpr double kLargestBaseline = 50;          // degrees: farther views hardly correlate

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

void estimate_cost(Inspection& out) {
  double pixels = 0;
  for (const SourceView& view : out.scene.views)
    pixels += double(view.camera.intrinsics.width) * view.camera.intrinsics.height;
  const glm::dvec3 n(out.grid.voxels());
  const double surface = 2 * (n.x * n.y + n.y * n.z + n.z * n.x);
  // A pixel takes 4 bytes in memory and 4/3 of that with its mip chain on the device.
  out.memory_bytes =
      kBaseMemory + carving::estimate_memory(out.grid) + std::int64_t(pixels * (4 + 4 * 4.0 / 3));
  out.cpu_seconds = pixels * kSecondsPerPixel + surface * kSecondsPerSurfaceVoxel;
}

}  // namespace

Inspection inspect(const Scene& scene) {
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
  out.grid = carving::fit_grid(*scene.box, out.voxel_size * footprint_factor(Quality::kNormal));
  estimate_cost(out);
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
