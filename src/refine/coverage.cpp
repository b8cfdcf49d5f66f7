#include "refine/coverage.h"

#include <cmath>

#include "projtex/photographs.h"

namespace photohull::refine {
namespace {

constexpr double kBefore = 3;  // voxels between a point and what it would hide

}  // namespace

Coverage::Coverage(gpu::Context& context, const GridSpec& grid, std::span<const glm::ivec3> voxels,
                   std::span<const Camera> cameras,
                   std::span<const carving::Silhouette> silhouettes)
    : silhouettes_(silhouettes), cameras_(projtex::to_grid(cameras, grid)) {
  visibility::DepthMaps maps(cameras_, grid);
  maps.draw(context, cameras_, voxels);
  for (std::size_t v = 0; v < cameras_.size(); ++v) maps_.push_back(maps.map(v));
}

Coverage::Votes Coverage::votes(const glm::dvec3& point, double inside) const {
  Votes votes;
  for (std::size_t v = 0; v < cameras_.size(); ++v) {
    const SilhouetteDistance* s = silhouettes_[v].distance;
    const glm::dvec3 q = cameras_[v].projection * glm::dvec4(point, 1);
    if (!s || q.z <= 1) continue;
    const double x = q.x / q.z, y = q.y / q.z;
    const int px = int(std::floor(x + 0.5)), py = int(std::floor(y + 0.5));
    if (px < 0 || py < 0 || px >= s->width || py >= s->height) continue;
    const float depth = maps_[v].at({x, y});
    const bool covered = !std::isinf(depth);
    votes.lack += !covered && s->pixels[std::size_t(py) * s->width + px] <= -inside;
    votes.before += covered && q.z + kBefore < depth;
  }
  return votes;
}

}  // namespace photohull::refine
