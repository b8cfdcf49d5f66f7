#include "carving/join_parts.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <unordered_map>

#include "core/error.h"

namespace photohull::carving {
namespace {

using glm::ivec3;

constexpr int kLongest = 8;  // voxels of a path

/// Joints that are taken so far and the volume's voxels beside joints, with what hangs together:
/// over faces, for the surface may part voxels that share less.
class Graph {
 public:
  Graph(const SparseVolume& volume, std::span<const Joint> joints)
      : size_(volume.grid.voxels()), joints_(joints.size()), taken_(joints.size(), false) {
    for (const Joint& joint : joints) add(joint.voxel);
    for (const Joint& joint : joints)
      for_each_neighbour(joint.voxel, [&](const ivec3& voxel) {
        if (volume.at(voxel) < 0) add(voxel);
      });
    parent_.resize(voxels_.size());
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (std::uint32_t node = std::uint32_t(joints_); node < voxels_.size(); ++node)
      for (const std::uint32_t other : neighbours(node)) parent_[root(node)] = root(other);
  }

  /// Takes a joint. Returns those on the paths from it to parts that it brings together.
  std::vector<std::uint32_t> take(std::uint32_t joint) {
    std::set<std::uint32_t> sets, parts;
    for (const std::uint32_t node : neighbours(joint)) sets.insert(root(node));
    for (const std::uint32_t set : sets)
      if (holds_volume(set)) parts.insert(set);
    std::vector<std::uint32_t> joined;
    if (parts.size() > 1) {
      joined.push_back(joint);
      for (const std::uint32_t part : parts) add_path(joint, part, joined);
    }
    taken_[joint] = true;
    for (const std::uint32_t set : sets) {
      const std::uint32_t own = root(joint), other = root(set);
      const bool volume = holds_volume(own) || holds_volume(other);
      parent_[std::max(own, other)] = std::min(own, other);
      if (volume) with_volume_.insert(std::min(own, other));
    }
    return joined;
  }

 private:
  template <typename Visit>
  void for_each_neighbour(const ivec3& voxel, const Visit& visit) const {
    for (int axis = 0; axis < 3; ++axis)
      for (const int sign : {-1, 1}) {
        ivec3 step(0);
        step[axis] = sign;
        visit(voxel + step);
      }
  }
  std::int64_t key(const ivec3& v) const {
    return (std::int64_t(v.z + 1) * (size_.y + 2) + v.y + 1) * (size_.x + 2) + v.x + 1;
  }
  void add(const ivec3& voxel) {
    if (node_at_.try_emplace(key(voxel), std::uint32_t(voxels_.size())).second)
      voxels_.push_back(voxel);
  }
  bool is_there(std::uint32_t node) const { return node >= joints_ || taken_[node]; }
  std::vector<std::uint32_t> neighbours(std::uint32_t node) const {
    std::vector<std::uint32_t> found;
    for_each_neighbour(voxels_[node], [&](const ivec3& voxel) {
      const auto at = node_at_.find(key(voxel));
      if (at != node_at_.end() && is_there(at->second)) found.push_back(at->second);
    });
    return found;
  }
  std::uint32_t root(std::uint32_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }
  bool holds_volume(std::uint32_t set) const {
    return set >= joints_ || with_volume_.contains(set);
  }

  /// The joints on the shortest path from one to a voxel of the volume in a part.
  void add_path(std::uint32_t from, std::uint32_t part, std::vector<std::uint32_t>& out) {
    std::unordered_map<std::uint32_t, std::uint32_t> came_from{{from, from}};
    std::vector<std::uint32_t> front{from}, next;
    for (int step = 0; step < kLongest && !front.empty(); ++step, front.swap(next)) {
      next.clear();
      for (const std::uint32_t node : front)
        for (const std::uint32_t other : neighbours(node)) {
          if (root(other) != part || !came_from.try_emplace(other, node).second) continue;
          if (other < joints_) {
            next.push_back(other);
            continue;
          }
          for (std::uint32_t back = node; back != from; back = came_from.at(back))
            out.push_back(back);
          return;
        }
    }
  }

  ivec3 size_;
  std::size_t joints_;  ///< the first nodes
  std::vector<bool> taken_;
  std::vector<ivec3> voxels_;
  std::unordered_map<std::int64_t, std::uint32_t> node_at_;
  std::vector<std::uint32_t> parent_;
  std::set<std::uint32_t> with_volume_;  ///< roots that are joints
};

}  // namespace

std::vector<std::size_t> find_joining(const SparseVolume& volume, std::span<const Joint> joints) {
  std::vector<std::uint32_t> order(joints.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return joints[a].distance != joints[b].distance ? joints[a].distance < joints[b].distance
                                                    : a < b;
  });
  Graph graph(volume, joints);
  std::set<std::size_t> joining;
  for (const std::uint32_t joint : order)
    for (const std::uint32_t on_path : graph.take(joint)) joining.insert(on_path);
  return {joining.begin(), joining.end()};
}

void put(const Joint& joint, SparseVolume& volume) {
  const std::uint32_t slot = volume.table[volume.grid.brick_index(joint.voxel / kBrickEdge)];
  PHOTOHULL_CHECK_OP(slot, <, volume.bricks.size());
  volume.distance[std::size_t(slot) * kBrickVoxels +
                  std::size_t(voxel_offset(joint.voxel % kBrickEdge))] = joint.distance;
}

}  // namespace photohull::carving
