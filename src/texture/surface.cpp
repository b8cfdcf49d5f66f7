#include "texture/surface.h"

#include <algorithm>

namespace photohull::texture {
namespace {

/// A side of a triangle, without direction.
struct Side {
  std::uint32_t low, high, triangle;
  int place;
  bool same_edge(const Side& o) const { return low == o.low && high == o.high; }
  bool operator<(const Side& o) const {
    return low != o.low ? low < o.low : high != o.high ? high < o.high : triangle < o.triangle;
  }
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> neighbours_of(const TriMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, i});
    }
  std::sort(sides.begin(), sides.end());
  std::vector<std::array<std::uint32_t, 3>> out(mesh.triangles.size(), {kNoFace, kNoFace, kNoFace});
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    while (end < sides.size() && sides[end].same_edge(sides[first])) ++end;
    if (end - first != 2) continue;
    const Side &a = sides[first], &b = sides[first + 1];
    out[a.triangle][a.place] = b.triangle;
    out[b.triangle][b.place] = a.triangle;
  }
  return out;
}

}  // namespace photohull::texture
