#include "refine/thin_hull.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "carving/join_parts.h"
#include "carving/thin_parts.h"

namespace photohull::refine {
namespace {

using glm::ivec3;

constexpr int kAround = 2;            // voxels to either side that tell how deep the hull is
constexpr float kShell = 1.0f;        // voxels outside the part whose distances come along
constexpr float kNoticeable = 0.02f;  // voxels

bool is_thin(const SparseVolume& hull, const ivec3& voxel, float depth) {
  // Where it is not, this shows at the cube's corners and in the middle of its edges and faces.
  for (int n = 0; n < 27; ++n)
    if (hull.at(voxel + kAround * (ivec3(n / 9, n / 3 % 3, n % 3) - 1)) < -depth) return false;
  for (int x = -kAround; x <= kAround; ++x)
    for (int y = -kAround; y <= kAround; ++y)
      for (int z = -kAround; z <= kAround; ++z)
        if (hull.at(voxel + ivec3(x, y, z)) < -depth) return false;
  return true;
}

/// The step, to one of 26 neighbours, along which the hull is thinnest.
ivec3 across(const SparseVolume& hull, const ivec3& voxel) {
  ivec3 best(1, 0, 0);
  float most = -1;
  for (int n = 14; n < 27; ++n) {  // one of each pair of opposite directions
    const ivec3 step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
    const float rise = (hull.at(voxel + step) + hull.at(voxel - step) - 2 * hull.at(voxel)) /
                       std::sqrt(float(step.x * step.x + step.y * step.y + step.z * step.z));
    if (rise > most) most = rise, best = step;
  }
  return best;
}

/// Is nothing left of the part that the hull has here, across its thickness?
bool is_torn(const SparseVolume& hull, const SparseVolume& volume, const ivec3& voxel) {
  const glm::dvec3 step = 0.5 * glm::normalize(glm::dvec3(across(hull, voxel)));
  for (int i = -2 * kAround; i <= 2 * kAround; ++i)
    if (volume.interpolated(glm::dvec3(voxel) + double(i) * step) < 0) return false;
  return true;
}

}  // namespace

std::size_t keep_thin_hull(const SparseVolume& hull, const ThinHullOptions& options,
                           SparseVolume& volume) {
  if (options.depth == 0) return 0;
  struct Change {
    std::size_t index;  // of volume.distance
    float value;
  };
  std::vector<std::vector<Change>> changes(volume.bricks.size());
  tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
    const std::uint32_t of_hull = hull.table[hull.grid.brick_index(volume.bricks[slot])];
    if (of_hull >= hull.bricks.size()) return;  // all of it outside or inside
    for (int i = 0; i < kBrickVoxels; ++i) {
      const float bound = hull.distance[std::size_t(of_hull) * kBrickVoxels + std::size_t(i)];
      const std::size_t index = slot * kBrickVoxels + std::size_t(i);
      const float own = volume.distance[index];
      if (bound < -float(options.depth) || bound > kShell || own > float(options.reach) ||
          own < bound + kNoticeable || own < 0)  // nothing is torn that is there
        continue;
      const ivec3 voxel = volume.bricks[slot] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7);
      if (is_thin(hull, voxel, float(options.depth)) && is_torn(hull, volume, voxel))
        changes[slot].push_back({index, bound});
    }
  });
  std::size_t count = 0;
  for (const std::vector<Change>& part : changes)
    for (const auto& [index, value] : part) {
      count += volume.distance[index] > 0 && value < 0;
      volume.distance[index] = value;
    }
  return count;
}

std::size_t rejoin_stems(const SparseVolume& hull, std::span<const Camera> cameras,
                         std::span<const carving::Silhouette> silhouettes,
                         const ThinHullOptions& options, SparseVolume& volume) {
  const bool lines = std::any_of(silhouettes.begin(), silhouettes.end(),
                                 [](const auto& s) { return s.lines && !s.lines->empty(); });
  if (options.depth == 0 || !lines) return 0;
  std::vector<std::vector<carving::Joint>> found(volume.bricks.size());
  tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
    const std::uint32_t of_hull = hull.table[hull.grid.brick_index(volume.bricks[slot])];
    if (of_hull >= hull.bricks.size()) return;
    for (int i = 0; i < kBrickVoxels; ++i) {
      const float bound = hull.distance[std::size_t(of_hull) * kBrickVoxels + std::size_t(i)];
      if (bound >= 0 || volume.distance[slot * kBrickVoxels + std::size_t(i)] < 0) continue;
      const ivec3 voxel = volume.bricks[slot] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7);
      if (is_thin(hull, voxel, float(options.depth))) found[slot].push_back({voxel, bound});
    }
  });
  std::vector<carving::Joint> joints;
  for (const auto& list : found) joints.insert(joints.end(), list.begin(), list.end());
  std::vector<ivec3> voxels;
  for (const carving::Joint& joint : joints) voxels.push_back(joint.voxel);
  const std::vector<bool> shown = carving::on_stems(volume.grid, cameras, silhouettes, voxels);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (shown[i]) joints[kept++] = joints[i];
  joints.resize(kept);
  const std::vector<std::size_t> joining = carving::find_joining(volume, joints);
  for (const std::size_t i : joining) carving::put(joints[i], volume);
  return joining.size();
}

}  // namespace photohull::refine
