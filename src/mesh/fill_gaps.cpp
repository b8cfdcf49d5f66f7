#include "mesh/fill_gaps.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace photohull {
namespace {

constexpr std::size_t kLongestGap = 1000;  // edges: more are no gap between parts
constexpr double kWidestGap = 8;           // times the reach, from one part to the other

/// Loops of kLongestGap sides at most, without a vertex that comes twice, along sides of a border,
/// each side in one at most.
class Loops {
 public:
  explicit Loops(const std::vector<Side>& border) {
    for (const Side& side : border) next_[side.from].push_back(side.to);
  }

  /// Goes on from a vertex as long as there are sides that no loop has; visit(loop).
  template <typename Visit>
  void walk(std::uint32_t first, const Visit& visit) {
    std::vector<std::uint32_t> path{first};
    for (auto* ends = &next_[first]; !ends->empty(); ends = &next_[path.back()]) {
      const std::uint32_t end = ends->back();
      ends->pop_back();
      const auto met = std::find(path.end() - std::ptrdiff_t(std::min(path.size(), kLongestGap)),
                                 path.end(), end);
      if (met == path.end()) {
        path.push_back(end);
        continue;
      }
      visit(std::vector<std::uint32_t>(met, path.end()));
      path.erase(met + 1, path.end());
    }
  }

 private:
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> next_;
};

/// Is what a loop goes around a gap between parts, whose borders are near each other all along it?
/// `parts`: of the vertices, and kSeam of those that several have.
bool is_gap(const std::vector<std::uint32_t>& loop, const std::vector<std::uint32_t>& parts,
            const TriMesh& mesh, double reach) {
  if (loop.size() < 3) return false;
  return std::ranges::all_of(loop, [&](std::uint32_t a) {
    return parts[a] == kSeam || std::ranges::any_of(loop, [&](std::uint32_t b) {
             return parts[b] != parts[a] &&
                    double(glm::distance(mesh.positions[a], mesh.positions[b])) <=
                        kWidestGap * reach;
           });
  });
}

/// Triangles that fill a loop, and run the other way: the corner whose neighbours are nearest to
/// each other is cut off again and again, but for neighbours that a side of the mesh (`sides`)
/// joins already.
void fill(std::vector<std::uint32_t> loop, const std::vector<Side>& sides, TriMesh& mesh) {
  const auto joined = [&](std::uint32_t a, std::uint32_t b) {
    return opposite(sides, {a, b, 0}) || opposite(sides, {b, a, 0});
  };
  while (loop.size() > 3) {
    const std::size_t n = loop.size();
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t before = loop[(i + n - 1) % n], after = loop[(i + 1) % n];
      const double length = double(glm::distance(mesh.positions[before], mesh.positions[after]));
      if (length < least && !joined(before, after)) best = i, least = length;
    }
    mesh.triangles.push_back({loop[(best + 1) % n], loop[best], loop[(best + n - 1) % n]});
    loop.erase(loop.begin() + std::ptrdiff_t(best));
  }
  mesh.triangles.push_back({loop[2], loop[1], loop[0]});
}

}  // namespace

std::size_t fill_gaps(const std::vector<Side>& open, const std::vector<std::uint32_t>& parts,
                      double reach, TriMesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh.triangles);
  std::size_t filled = 0;
  Loops loops(open);
  for (const Side& side : open)
    loops.walk(side.from, [&](std::vector<std::uint32_t> loop) {
      if (!is_gap(loop, parts, mesh, reach)) return;
      fill(std::move(loop), sides, mesh);
      ++filled;
    });
  return filled;
}

}  // namespace photohull
