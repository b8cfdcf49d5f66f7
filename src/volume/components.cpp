// Component labelling by union-find (Tarjan 1975) over the parts within each brick, which are
// found on bit masks.
#include "volume/components.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace photohull {
namespace {

/// A set of voxels of a brick: word x, bit y * 8 + z, the order of voxel_offset.
using Mask = std::array<std::uint64_t, kBrickEdge>;

constexpr Mask kFull = {~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull};

bool any(const Mask& mask) {
  return std::any_of(mask.begin(), mask.end(), [](std::uint64_t word) { return word != 0; });
}

bool overlap(const Mask& a, const Mask& b) {
  std::uint64_t common = 0;
  for (int x = 0; x < kBrickEdge; ++x) common |= a[x] & b[x];
  return common != 0;
}

Mask inside_mask(const float* distance) {
  Mask mask{};
  for (int i = 0; i < kBrickVoxels; ++i) mask[i >> 6] |= std::uint64_t(distance[i] < 0) << (i & 63);
  return mask;
}

/// Columns z < count of every row.
std::uint64_t low_columns(int count) { return 0x0101010101010101ull * ((1u << count) - 1); }

/// A slice moved by `step` along z (columns) or y (rows); what leaves the slice is lost.
std::uint64_t shift_z(std::uint64_t m, int step) {
  return step >= 0 ? (m << step) & ~low_columns(step) : (m >> -step) & low_columns(8 + step);
}
std::uint64_t shift_y(std::uint64_t m, int step) {
  return step >= 0 ? m << (8 * step) : m >> (-8 * step);
}

/// Union of a slice's copies moved so far that voxels reach those of the neighbour slice in
/// `direction` (-1, 0, 1 along one axis) at most `radius` voxels away; in the neighbour's frame.
template <typename Shift>
std::uint64_t reach_slice(std::uint64_t m, int direction, int radius, Shift shift) {
  std::uint64_t out = direction == 0 ? m : 0;
  for (int k = 1; k <= radius; ++k) {
    if (direction == 0) out |= shift(m, k) | shift(m, -k);
    if (direction > 0) out |= shift(m, k - kBrickEdge);
    if (direction < 0) out |= shift(m, kBrickEdge - k);
  }
  return out;
}

/// The voxels of the neighbour brick in `direction` (0: of this brick) that are at most `radius`
/// (1 to 7) voxels along each axis from a voxel of the mask.
Mask reach(const Mask& mask, const glm::ivec3& direction, int radius) {
  Mask out{};
  for (int x = 0; x < kBrickEdge; ++x) {
    if (mask[x] == 0) continue;
    const std::uint64_t rows = reach_slice(mask[x], direction.y, radius, shift_y);
    const std::uint64_t slice = reach_slice(rows, direction.z, radius, shift_z);
    const int center = x - kBrickEdge * direction.x;
    const int last = std::min(center + radius, kBrickEdge - 1);
    for (int to = std::max(center - radius, 0); to <= last; ++to) out[to] |= slice;
  }
  return out;
}

/// Splits a mask into its connected parts, by flooding from its lowest voxel again and again.
std::vector<Mask> split(Mask mask) {
  std::vector<Mask> parts;
  while (any(mask)) {
    Mask part{};
    const int x =
        int(std::find_if(mask.begin(), mask.end(), [](auto w) { return w != 0; }) - mask.begin());
    part[x] = mask[x] & -mask[x];
    for (Mask before{}; part != before;) {
      before = part;
      part = reach(part, glm::ivec3(0), 1);
      for (int i = 0; i < kBrickEdge; ++i) part[i] &= mask[i];
    }
    for (int i = 0; i < kBrickEdge; ++i) mask[i] &= ~part[i];
    parts.push_back(part);
  }
  return parts;
}

/// The neighbour of a brick as an index into the table; nothing outside the grid.
constexpr std::size_t kNoBrick = ~std::size_t(0);

std::size_t neighbour(const GridSpec& grid, const glm::ivec3& brick, const glm::ivec3& step) {
  const glm::ivec3 b = brick + step;
  if (glm::any(glm::lessThan(b, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(b, grid.bricks)))
    return kNoBrick;
  return grid.brick_index(b);
}

glm::ivec3 step_of(int n) { return {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}; }

/// The graph of the connected parts within bricks; an unstored inside brick is one part. Nodes
/// are numbered in the order of the table.
class Components {
 public:
  explicit Components(const SparseVolume& volume) : volume_(volume) {
    find_nodes();
    sets_ = DisjointSets(mask_of_node_.size());
    connect();
  }

  /// Voxel count of each component at its root node; 0 at other nodes.
  std::vector<std::size_t> root_sizes();
  std::uint32_t root(std::uint32_t node) { return sets_.root(node); }
  /// The nodes in a brick of the table are [first_node(brick), first_node(brick + 1)).
  std::uint32_t first_node(std::size_t brick) const { return first_[brick]; }
  const Mask& mask(std::uint32_t node) const { return masks_[mask_of_node_[node]]; }

 private:
  void find_nodes();
  void connect();
  void connect_bricks(std::size_t a, std::size_t b, const glm::ivec3& step);

  const SparseVolume& volume_;
  std::vector<std::uint32_t> first_;         ///< per brick of the table, and one past the last
  std::vector<std::uint32_t> mask_of_node_;  ///< index into masks_
  std::vector<Mask> masks_{kFull};           ///< the first one serves all unstored inside bricks
  DisjointSets sets_;
};

void Components::find_nodes() {
  std::vector<std::vector<Mask>> parts(volume_.bricks.size());
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t slot) {
    parts[slot] = split(inside_mask(volume_.distance.data() + slot * kBrickVoxels));
  });
  first_.reserve(volume_.table.size() + 1);
  for (const std::uint32_t slot : volume_.table) {
    first_.push_back(std::uint32_t(mask_of_node_.size()));
    if (slot == SparseVolume::kInside) mask_of_node_.push_back(0);
    if (slot >= parts.size()) continue;
    for (const Mask& part : parts[slot]) {
      mask_of_node_.push_back(std::uint32_t(masks_.size()));
      masks_.push_back(part);
    }
  }
  first_.push_back(std::uint32_t(mask_of_node_.size()));
}

void Components::connect() {
  const glm::ivec3 size = volume_.grid.bricks;
  std::size_t brick = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++brick) {
        if (first_[brick] == first_[brick + 1]) continue;
        for (int n = 14; n < 27; ++n) {  // One of each pair of opposite directions.
          const std::size_t other = neighbour(volume_.grid, {x, y, z}, step_of(n));
          if (other != kNoBrick) connect_bricks(brick, other, step_of(n));
        }
      }
}

void Components::connect_bricks(std::size_t a, std::size_t b, const glm::ivec3& step) {
  for (std::uint32_t i = first_[a]; i < first_[a + 1]; ++i)
    for (std::uint32_t j = first_[b]; j < first_[b + 1]; ++j) {
      if (sets_.root(i) == sets_.root(j)) continue;
      const bool both_full = mask_of_node_[i] == 0 && mask_of_node_[j] == 0;
      if (both_full || overlap(reach(mask(i), step, 1), mask(j))) sets_.unite(i, j);
    }
}

std::vector<std::size_t> Components::root_sizes() {
  std::vector<std::size_t> sizes(mask_of_node_.size(), 0);
  for (std::uint32_t node = 0; node < sizes.size(); ++node)
    for (const std::uint64_t word : mask(node)) sizes[root(node)] += std::popcount(word);
  return sizes;
}

/// Which nodes go, and what that does to the volume.
class Removal {
 public:
  Removal(SparseVolume& volume, const Components& components, std::vector<bool> dropped)
      : volume_(volume), components_(components), dropped_(std::move(dropped)) {}
  void perform();

 private:
  /// Union of a brick's dropped or of its kept parts.
  Mask parts(std::size_t brick, bool dropped) const;
  /// The voxels of a brick from which a dropped or a kept part is in the band's reach.
  Mask near(const glm::ivec3& brick, bool dropped) const;
  std::vector<std::uint32_t> affected_slots() const;
  void erase(std::uint32_t slot);

  SparseVolume& volume_;
  const Components& components_;
  std::vector<bool> dropped_;  ///< per node
};

Mask Removal::parts(std::size_t brick, bool dropped) const {
  Mask out{};
  for (auto node = components_.first_node(brick); node < components_.first_node(brick + 1); ++node)
    if (dropped_[node] == dropped)
      for (int x = 0; x < kBrickEdge; ++x) out[x] |= components_.mask(node)[x];
  return out;
}

Mask Removal::near(const glm::ivec3& brick, bool dropped) const {
  Mask out{};
  for (int n = 0; n < 27; ++n) {
    const std::size_t other = neighbour(volume_.grid, brick, step_of(n));
    if (other == kNoBrick) continue;
    const Mask reached = reach(parts(other, dropped), -step_of(n), int(SparseVolume::kBand));
    for (int x = 0; x < kBrickEdge; ++x) out[x] |= reached[x];
  }
  return out;
}

/// The stored bricks with a dropped part in them or in a brick around them.
std::vector<std::uint32_t> Removal::affected_slots() const {
  const GridSpec& grid = volume_.grid;
  std::vector<std::uint32_t> slots;
  std::size_t brick = 0;
  for (int z = 0; z < grid.bricks.z; ++z)
    for (int y = 0; y < grid.bricks.y; ++y)
      for (int x = 0; x < grid.bricks.x; ++x, ++brick) {
        if (components_.first_node(brick) == components_.first_node(brick + 1)) continue;
        if (!any(parts(brick, true))) continue;
        for (int n = 0; n < 27; ++n) {
          const std::size_t other = neighbour(grid, {x, y, z}, step_of(n));
          if (other != kNoBrick && volume_.table[other] < volume_.bricks.size())
            slots.push_back(volume_.table[other]);
        }
      }
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  return slots;
}

/// A speck's shell of positive distances goes with it: it would stay in the band as a ghost.
void Removal::erase(std::uint32_t slot) {
  const glm::ivec3 brick = volume_.bricks[slot];
  const Mask gone = parts(volume_.grid.brick_index(brick), true);
  const Mask near_dropped = near(brick, true);
  const Mask near_kept = near(brick, false);
  float* distance = volume_.distance.data() + std::size_t(slot) * kBrickVoxels;
  for (int i = 0; i < kBrickVoxels; ++i) {
    const std::uint64_t clear = gone[i >> 6] | (near_dropped[i >> 6] & ~near_kept[i >> 6]);
    if (clear >> (i & 63) & 1) distance[i] = SparseVolume::kBand;
  }
}

void Removal::perform() {
  const std::vector<std::uint32_t> slots = affected_slots();
  tbb::parallel_for(std::size_t(0), slots.size(), [&](std::size_t i) { erase(slots[i]); });
  for (std::size_t brick = 0; brick < volume_.table.size(); ++brick)
    if (volume_.table[brick] == SparseVolume::kInside && dropped_[components_.first_node(brick)])
      volume_.table[brick] = SparseVolume::kOutside;
}

/// Takes back the nodes of those components that are wanted.
void keep_wanted(const SparseVolume& volume, Components& components, const AreWanted& are_wanted,
                 std::vector<bool>& dropped) {
  std::map<std::uint32_t, std::size_t> piece_of;  // by root
  std::vector<std::vector<glm::ivec3>> pieces;
  const glm::ivec3 bricks = volume.grid.bricks;
  for (std::size_t brick = 0; brick < volume.table.size(); ++brick)
    for (auto node = components.first_node(brick); node < components.first_node(brick + 1);
         ++node) {
      if (!dropped[node]) continue;
      const auto [at, is_new] = piece_of.try_emplace(components.root(node), pieces.size());
      if (is_new) pieces.emplace_back();
      const glm::ivec3 low =
          kBrickEdge * glm::ivec3(brick % std::size_t(bricks.x),
                                  brick / std::size_t(bricks.x) % std::size_t(bricks.y),
                                  brick / (std::size_t(bricks.x) * std::size_t(bricks.y)));
      for (int i = 0; i < kBrickVoxels; ++i)
        if (components.mask(node)[std::size_t(i >> 6)] >> (i & 63) & 1)
          pieces[at->second].push_back(low + glm::ivec3(i >> 6, (i >> 3) & 7, i & 7));
    }
  if (pieces.empty()) return;
  const std::vector<bool> wanted = are_wanted(pieces);
  for (std::uint32_t node = 0; node < dropped.size(); ++node)
    if (dropped[node] && wanted[piece_of.at(components.root(node))]) dropped[node] = false;
}

}  // namespace

std::vector<std::size_t> component_sizes(const SparseVolume& volume) {
  std::vector<std::size_t> sizes = Components(volume).root_sizes();
  std::erase(sizes, std::size_t(0));
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  return sizes;
}

RemovedComponents remove_small_components(SparseVolume& volume, double fraction,
                                          const AreWanted& are_wanted) {
  if (!(fraction >= 0 && fraction <= 1))
    throw UsageError(
        concat("smallest component to keep is ", fraction, "; choose a fraction from 0 to 1."));
  RemovedComponents removed;
  Components components(volume);
  const std::vector<std::size_t> sizes = components.root_sizes();
  if (sizes.empty()) return removed;
  const double least = fraction * double(*std::max_element(sizes.begin(), sizes.end()));
  std::vector<bool> dropped(sizes.size());
  for (std::uint32_t node = 0; node < sizes.size(); ++node) {
    dropped[node] = double(sizes[components.root(node)]) < least;
  }
  if (are_wanted) keep_wanted(volume, components, are_wanted, dropped);
  for (std::uint32_t node = 0; node < sizes.size(); ++node) {
    if (!dropped[node] || components.root(node) != node) continue;
    ++removed.components;
    removed.voxels += sizes[node];
  }
  if (removed.components > 0) Removal(volume, components, std::move(dropped)).perform();
  return removed;
}

}  // namespace photohull
