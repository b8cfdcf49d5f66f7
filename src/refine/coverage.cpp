#include "refine/coverage.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "projtex/photographs.h"

namespace photohull::refine {
namespace {

constexpr double kBefore = 3;  // voxels between a point and what it would hide

}  // namespace

Coverage::Coverage(gpu::Context& context, const GridSpec& grid, std::span<const glm::ivec3> voxels,
                   const SilhouetteCones& cones)
    : silhouettes_(cones.silhouettes), cameras_(projtex::to_grid(cones.cameras, grid)) {
  visibility::DepthMaps maps(cameras_, grid);
  if (!cones.beside.empty()) maps.draw(cones.beside, 1 / grid.voxel_size);
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

Coverage::LackingPixels Coverage::lacking_pixels(double inside) const {
  LackingPixels out(maps_.size());
  tbb::parallel_for(std::size_t(0), maps_.size(), [&](std::size_t v) {
    const SilhouetteDistance* s = silhouettes_[v].distance;
    if (!s) return;
    const DepthMap& map = maps_[v];
    const auto scale = double(map.texels_per_pixel);
    // A pixel is at most as wide as a texel: it touches those at its ends.
    const auto texels = [&](int pixels, int size) {
      std::vector<std::array<int, 2>> ends;
      for (int i = 0; i < pixels; ++i)
        ends.push_back(
            {std::min(int(i * scale), size - 1), std::min(int((i + 1) * scale), size - 1)});
      return ends;
    };
    const auto columns = texels(s->width, map.size.x), rows = texels(s->height, map.size.y);
    std::vector<std::uint8_t> pixels(s->pixels.size(), 0);
    bool any = false;
    for (std::size_t y = 0, at = 0; y < rows.size(); ++y) {
      const float* high = map.depths.data() + std::ptrdiff_t(rows[y][0]) * map.size.x;
      const float* low = map.depths.data() + std::ptrdiff_t(rows[y][1]) * map.size.x;
      for (const auto& [left, right] : columns) {
        const bool bare =
            s->pixels[at] <= -inside && (std::isinf(high[left]) || std::isinf(high[right]) ||
                                         std::isinf(low[left]) || std::isinf(low[right]));
        pixels[at++] = bare;
        any = any || bare;
      }
    }
    if (any) out[v] = std::move(pixels);
  });
  return out;
}

int Coverage::most_lack(const glm::dvec3& point, const LackingPixels& lacking) const {
  int lack = 0;
  for (std::size_t v = 0; v < cameras_.size(); ++v) {
    if (lacking[v].empty()) continue;
    const glm::dvec3 q = cameras_[v].projection * glm::dvec4(point, 1);
    if (q.z <= 1) continue;
    const SilhouetteDistance& s = *silhouettes_[v].distance;
    const double x = q.x / q.z + 0.5, y = q.y / q.z + 0.5;
    if (!(x >= 0 && y >= 0 && x < s.width && y < s.height)) continue;
    lack += lacking[v][std::size_t(int(y)) * std::size_t(s.width) + std::size_t(int(x))];
  }
  return lack;
}

}  // namespace photohull::refine
