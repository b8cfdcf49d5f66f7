#include "assess/surface_probes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "eval/surface_samples.h"

namespace photohull::assess {
namespace {

constexpr double kLeastCosine = 0.26;  // 75 degrees
constexpr std::uint64_t kSeed = 1;

SurfaceProbe probe_at(const TriMesh& mesh, const glm::dvec3& point, std::uint32_t triangle) {
  const auto& corners = mesh.triangles[triangle];
  const glm::dvec3 a = mesh.world(corners[0]), b = mesh.world(corners[1]),
                   c = mesh.world(corners[2]);
  SurfaceProbe probe;
  probe.point = point;
  const glm::dvec3 across = glm::cross(b - a, c - a);
  const double length = glm::length(across);
  if (length > 0) probe.normal = across / length;
  for (const std::uint32_t corner : corners) probe.confidence += mesh.confidence[corner] / 3;
  return probe;
}

}  // namespace

std::vector<SurfaceProbe> probe_surface(const TriMesh& mesh, const RayScene& rays,
                                        std::span<const Camera> cameras, std::size_t count,
                                        double lift) {
  const eval::SurfaceSamples samples = eval::sample_surface(mesh, count, kSeed);
  std::vector<SurfaceProbe> probes(samples.points.size());
  tbb::parallel_for(std::size_t(0), probes.size(), [&](std::size_t i) {
    SurfaceProbe& probe = probes[i];
    probe = probe_at(mesh, samples.points[i], samples.triangles[i]);
    const glm::dvec3 lifted = probe.point + lift * probe.normal;
    std::vector<std::pair<double, int>> seen;
    for (std::size_t v = 0; v < cameras.size(); ++v) {
      const glm::dvec3 to_camera = cameras[v].center() - lifted;
      const double cosine = glm::dot(glm::normalize(to_camera), probe.normal);
      if (!(cosine > kLeastCosine)) continue;
      const auto pixel = cameras[v].project(probe.point);
      if (!pixel || !cameras[v].on_image(*pixel)) continue;
      if (!rays.occluded(lifted, to_camera, 0, 1)) seen.emplace_back(-cosine, int(v));
    }
    std::sort(seen.begin(), seen.end());
    for (const auto& [order, view] : seen) probe.views.push_back(view);
  });
  return probes;
}

}  // namespace photohull::assess
