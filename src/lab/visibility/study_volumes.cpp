#include <algorithm>
#include <cmath>

#include "lab/visibility/study_parts.h"
#include "lab/visibility/study_receivers.h"
#include "visibility/truth.h"
#include "visibility/viewpoints.h"

namespace photohull::visibility {
namespace {

using glm::dvec3;
using glm::ivec3;

/// A gyroid within a ball: many layers deep, whole bricks inside and outside.
SparseVolume gyroid_ball(int bricks) {
  SparseVolume volume;
  const int n = bricks * kBrickEdge;
  volume.grid = {dvec3(-1), 2.0 / n, ivec3(bricks)};
  const auto value = [&](const ivec3& voxel) {
    const dvec3 p = volume.grid.world(voxel), q = 9.0 * p;
    const double gyroid = std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) +
                          std::sin(q.z) * std::cos(q.x);
    return std::max(gyroid, glm::length(p) - 0.95);
  };
  for (int z = 0; z < bricks; ++z)
    for (int y = 0; y < bricks; ++y)
      for (int x = 0; x < bricks; ++x) {
        std::vector<float> brick(kBrickVoxels);
        int inside = 0;
        for (int i = 0; i < kBrickVoxels; ++i) {
          const ivec3 local(i >> 6, i >> 3 & 7, i & 7);
          brick[std::size_t(i)] = value(ivec3(x, y, z) * kBrickEdge + local) < 0 ? -1.0f : 1.0f;
          inside += brick[std::size_t(i)] < 0;
        }
        if (inside == 0 || inside == kBrickVoxels) {
          volume.table.push_back(inside ? SparseVolume::kInside : SparseVolume::kOutside);
          continue;
        }
        volume.table.push_back(std::uint32_t(volume.bricks.size()));
        volume.bricks.emplace_back(x, y, z);
        volume.distance.insert(volume.distance.end(), brick.begin(), brick.end());
      }
  return volume;
}

/// Middles of exposed faces that face the viewpoint.
std::vector<Sample> face_samples(const TriMesh& faces, const Camera& viewpoint) {
  std::vector<Sample> out;
  for (std::size_t i = 0; i + 1 < faces.triangles.size(); i += 2 * 7) {
    const auto& t = faces.triangles[i];
    const dvec3 a = faces.world(t[0]), b = faces.world(t[1]), c = faces.world(t[2]);
    Sample s;
    const dvec3 n = glm::normalize(glm::cross(b - a, c - a));
    // The triangle's longest side is the face's diagonal.
    const dvec3 corners[] = {a, b, c};
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const dvec3 side = corners[(k + 1) % 3] - corners[k];
      if (glm::length(side) > longest)
        longest = glm::length(side), s.position = corners[k] + 0.5 * side;
    }
    s.normal = n;
    if (glm::dot(n, viewpoint.center() - s.position) > 0) out.push_back(s);
  }
  return out;
}

}  // namespace

std::vector<VolumeCell> study_volumes(gpu::Context& context, const StudyOptions& options,
                                      Progress& progress) {
  const SparseVolume volume = gyroid_ball(options.volume_bricks);
  const Geometry geometry = Geometry::of_volume(volume);
  const Camera viewpoint = frame_sphere({2.2, -1.6, 1.4}, {0, 0, 0}, 1.0, 1024, 1024);
  const std::vector<Sample> samples = face_samples(voxel_faces(volume), viewpoint);
  const std::vector<std::uint8_t> truth =
      visible_by_rays(VoxelRays(volume), volume.grid, viewpoint, samples, 0.01);
  std::vector<VolumeCell> out;
  for (const int resolution : options.resolutions)
    for (const bool march : {false, true}) {
      progress.check_cancelled();
      Technique t;
      t.resolution = resolution;
      t.march = march;
      VolumeCell cell{march ? "march" : "faces", resolution, 1e30, {}};
      const char* launch = march ? "visibility_march_bricks" : "visibility_draw_mesh";
      for (int repeat = 0; repeat <= options.repeats; ++repeat) {
        const gpu::LaunchStatistics before = context.statistics()[launch];
        const VisibilityMap map = render_map(context, viewpoint, geometry, t);
        const gpu::LaunchStatistics after = context.statistics()[launch];
        const bool software = context.device().software;
        const double ms = 1e3 * (software ? after.cpu_seconds - before.cpu_seconds
                                          : after.seconds - before.seconds);
        if (repeat) cell.map_ms = std::min(cell.map_ms, ms);
        if (!repeat) cell.errors = errors_of(visible(context, map, samples), truth);
      }
      out.push_back(cell);
    }
  return out;
}

}  // namespace photohull::visibility
