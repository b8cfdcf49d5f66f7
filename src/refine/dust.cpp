#include "refine/dust.h"

#include <algorithm>

#include "refine/coverage.h"

namespace photohull::refine {
namespace {

using glm::ivec3;

constexpr std::size_t kMostAsked = 9;  // voxels of a piece that are looked at

bool before(const ivec3& a, const ivec3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// Voxels at the volume's surface but for those of the pieces, which are in rising order.
std::vector<ivec3> skin_without(const SparseVolume& volume, const std::vector<ivec3>& left_out) {
  std::vector<ivec3> skin;
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot)
    for (int i = 0; i < kBrickVoxels; ++i) {
      const float d = volume.distance[slot * kBrickVoxels + std::size_t(i)];
      if (d >= 0 || d <= -1) continue;
      const ivec3 voxel = volume.bricks[slot] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7);
      if (!std::binary_search(left_out.begin(), left_out.end(), voxel, before))
        skin.push_back(voxel);
    }
  return skin;
}

}  // namespace

std::vector<bool> are_asked_for(gpu::Context& context, const SparseVolume& volume,
                                std::span<const std::vector<ivec3>> pieces,
                                const SilhouetteCones& cones, const DustOptions& options) {
  std::vector<bool> asked(pieces.size(), false);
  // Masks that were made close gaps on a guess: they ask for nothing.
  std::vector<carving::Silhouette> given(cones.silhouettes.begin(), cones.silhouettes.end());
  for (carving::Silhouette& s : given)
    if (s.likelihood) s = {};
  const auto known = std::count_if(given.begin(), given.end(),
                                   [](const carving::Silhouette& s) { return s.distance; });
  if (pieces.empty() || known == 0) return asked;
  std::vector<ivec3> all;
  for (const auto& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  std::sort(all.begin(), all.end(), before);
  const Coverage coverage(context, volume.grid, skin_without(volume, all),
                          {cones.cameras, given, cones.beside});
  const double least = std::max(double(options.least_views), options.view_share * double(known));
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const std::size_t stride = pieces[p].size() / kMostAsked + 1;
    std::vector<int> lacking;
    for (std::size_t i = 0; i < pieces[p].size(); i += stride)
      lacking.push_back(coverage.votes(glm::dvec3(pieces[p][i]), 0).lack);
    std::nth_element(lacking.begin(), lacking.begin() + long(lacking.size() / 2), lacking.end());
    asked[p] = lacking[lacking.size() / 2] >= least;
  }
  return asked;
}

}  // namespace photohull::refine
