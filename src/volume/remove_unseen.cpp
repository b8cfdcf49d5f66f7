#include "volume/remove_unseen.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <vector>

#include "volume/simplify_mesh.h"

namespace photohull {
namespace {

using Flags = std::vector<std::uint8_t>;
constexpr std::uint32_t kNone = 0xffffffffu;

/// For each side of each triangle the triangle across it, or kNone.
std::vector<std::array<std::uint32_t, 3>> neighbours(const TriMesh& mesh) {
  struct Side {
    std::uint32_t low, high, triangle, index;
  };
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]);
      sides.push_back({low, high, t, i});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  std::vector<std::array<std::uint32_t, 3>> across(mesh.triangles.size(), {kNone, kNone, kNone});
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &a = sides[i - 1], &b = sides[i];
    if (a.low != b.low || a.high != b.high) continue;
    across[a.triangle][a.index] = b.triangle;
    across[b.triangle][b.index] = a.triangle;
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

TriMesh remove_unseen(const TriMesh& mesh, double least_confidence, std::vector<float>* more) {
  TriMesh result = mesh;
  if (mesh.confidence.empty()) return result;
  const auto across = neighbours(mesh);
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
  result.triangles.clear();
  for (std::size_t t = 0; t < removed.size(); ++t)
    if (!removed[t]) result.triangles.push_back(mesh.triangles[t]);
  keep_used_vertices(result, more);
  return result;
}

}  // namespace photohull
