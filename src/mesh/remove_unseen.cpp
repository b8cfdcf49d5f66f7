#include "mesh/remove_unseen.h"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <numeric>
#include <vector>

namespace photohull {
namespace {

using Flags = std::vector<std::uint8_t>;
constexpr std::uint32_t kNone = 0xffffffffu;

/// For each side of each triangle the triangle across it, or kNone. Sides are looked at by their
/// lower corner, so that no list of all of them has to be sorted.
std::vector<std::array<std::uint32_t, 3>> neighbours(const TriMesh& mesh) {
  const auto low_of = [&](std::uint32_t t, std::uint32_t i) {
    return std::min(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]);
  };
  const auto for_sides = [&](auto&& f) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::uint32_t i = 0; i < 3; ++i) f(t, i);
  };
  std::vector<std::uint32_t> first(mesh.positions.size() + 2, 0);
  for_sides([&](std::uint32_t t, std::uint32_t i) { ++first[low_of(t, i) + 2]; });
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> listed(3 * mesh.triangles.size());  // triangles
  for_sides([&](std::uint32_t t, std::uint32_t i) { listed[first[low_of(t, i) + 1]++] = t; });
  // Now the list of vertex v begins at first[v].
  struct Side {
    std::uint32_t high, triangle, index;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  std::vector<std::array<std::uint32_t, 3>> across(mesh.triangles.size(), {kNone, kNone, kNone});
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    sides.clear();
    for (std::uint32_t k = first[v]; k < first[v + 1]; ++k)
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto& t = mesh.triangles[listed[k]];
        const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
        const bool again = k > first[v] && listed[k] == listed[k - 1];  // two sides begin here
        if (low == v && !again) sides.push_back({high, listed[k], i});
      }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const Side &a = sides[i - 1], &b = sides[i];
      if (a.high != b.high) continue;
      across[a.triangle][a.index] = b.triangle;
      across[b.triangle][b.index] = a.triangle;
    }
  }
  return across;
}

/// Flips the flag of triangles in patches of fewer than kLeastPatch with the flag `value`, joined
/// by edges; patches that touch none of the other flag stay.
void flip_small(const std::vector<std::array<std::uint32_t, 3>>& across, std::uint8_t value,
                Flags& flags) {
  Flags visited(flags.size());
  std::vector<std::uint32_t> patch;
  for (std::uint32_t start = 0; start < flags.size(); ++start) {
    if (visited[start] || flags[start] != value) continue;
    patch.assign(1, start);
    visited[start] = 1;
    bool touches = false;
    for (std::size_t i = 0; i < patch.size(); ++i)
      for (const std::uint32_t next : across[patch[i]]) {
        if (next == kNone) continue;
        touches |= flags[next] != value;
        if (visited[next] || flags[next] != value) continue;
        visited[next] = 1;
        patch.push_back(next);
      }
    if (touches && patch.size() < std::size_t(kLeastPatch))
      for (const std::uint32_t t : patch) flags[t] = !value;
  }
}

/// Removes triangles with removed ones across two sides or three, until none is left.
void remove_ears(const std::vector<std::array<std::uint32_t, 3>>& across, Flags& removed) {
  std::vector<std::uint32_t> todo(removed.size());
  std::iota(todo.begin(), todo.end(), 0u);
  while (!todo.empty()) {
    const std::uint32_t t = todo.back();
    todo.pop_back();
    if (removed[t]) continue;
    int bare = 0;
    for (const std::uint32_t next : across[t]) bare += next != kNone && removed[next];
    if (bare < 2) continue;
    removed[t] = 1;
    for (const std::uint32_t next : across[t])
      if (next != kNone) todo.push_back(next);
  }
}

}  // namespace

TriMesh remove_unseen(const TriMesh& mesh, double least_confidence, MoreNumbers more) {
  if (mesh.confidence.empty()) return mesh;
  std::vector<std::array<std::uint32_t, 3>> across = neighbours(mesh);
  Flags removed(mesh.triangles.size());
  for (std::size_t t = 0; t < removed.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto [least, most] =
        std::minmax({mesh.confidence[a], mesh.confidence[b], mesh.confidence[c]});
    removed[t] = most <= 0 || double(least) < least_confidence;
  }
  flip_small(across, 1, removed);
  remove_ears(across, removed);
  flip_small(across, 0, removed);
  across = {};
  TriMesh result{mesh.positions, mesh.origin, mesh.normals, mesh.colours, mesh.confidence, {}};
  for (std::size_t t = 0; t < removed.size(); ++t)
    if (!removed[t]) result.triangles.push_back(mesh.triangles[t]);
  keep_used_vertices(result, more);
  return result;
}

}  // namespace photohull
