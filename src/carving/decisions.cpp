#include "carving/decisions.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace photohull::carving {
namespace {

using glm::ivec3;
constexpr int kRadius = 2;      // columns around one that have a say: 24 neighbours
constexpr int kSlope = 2;       // layers a surface may climb from column to column
constexpr int kSupport = 8;     // neighbours that make an outcome trusted
constexpr int kLonely = 3;      // a kept voxel with fewer can be overruled
constexpr int kConsensus = 12;  // trusted neighbours that overrule

bool has_surface(const Decision& d) {
  return d.outcome == Outcome::kKept || d.outcome == Outcome::kBetter;
}

/// Decisions by column, sorted along it.
class ColumnMap {
 public:
  ColumnMap(int width, int height, std::span<const Decision> decisions)
      : width_(width), height_(height), first_(std::size_t(width) * height + 1) {
    sorted_.assign(decisions.begin(), decisions.end());
    std::sort(sorted_.begin(), sorted_.end(), [&](const Decision& a, const Decision& b) {
      return std::pair(index(a), a.bare) < std::pair(index(b), b.bare);
    });
    for (const Decision& d : sorted_) ++first_[index(d) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  }

  std::span<const Decision> all() const { return sorted_; }
  /// Calls f(decision number, in-plane distance) for the decisions of the columns around.
  template <typename F>
  void neighbours(const Decision& d, F&& f) const {
    for (int dv = -kRadius; dv <= kRadius; ++dv)
      for (int du = -kRadius; du <= kRadius; ++du) {
        const int u = d.column.x + du, v = d.column.y + dv;
        if ((du == 0 && dv == 0) || u < 0 || v < 0 || u >= width_ || v >= height_) continue;
        const std::size_t column = std::size_t(v) * width_ + u;
        for (std::size_t i = first_[column]; i < first_[column + 1]; ++i)
          f(i, std::max(std::abs(du), std::abs(dv)));
      }
  }

 private:
  std::size_t index(const Decision& d) const {
    return std::size_t(d.column.y) * width_ + d.column.x;
  }
  int width_, height_;
  std::vector<std::size_t> first_;
  std::vector<Decision> sorted_;
};

int median(std::vector<int>& values) {
  std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Surfaces around that continue this one, and its own: their layers.
std::vector<int> supporting_layers(const ColumnMap& map, const Decision& d) {
  std::vector<int> layers{d.surface};
  map.neighbours(d, [&](std::size_t i, int distance) {
    const Decision& other = map.all()[i];
    if (has_surface(other) && std::abs(other.surface - d.surface) <= kSlope * distance)
      layers.push_back(other.surface);
  });
  return layers;
}

/// Layer up to which the column of an untrusted decision is empty if its neighbours are right; the
/// decision's own bare layer when they are too few.
int consensus_layer(const ColumnMap& map, const std::vector<std::uint8_t>& trusted,
                    const Decision& d) {
  std::vector<int> layers;
  map.neighbours(d, [&](std::size_t i, int distance) {
    const Decision& other = map.all()[i];
    if (trusted[i] && std::abs(other.bare - d.bare) <= kSlope * distance + 2)
      layers.push_back(other.surface);
  });
  if (int(layers.size()) < kConsensus) return d.bare;
  return std::max(median(layers), d.bare);
}

}  // namespace

std::vector<ivec3> apply_decisions(BitVolume& bits, int axis, int sign,
                                   std::span<const Decision> decisions) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const ivec3 size = bits.grid.voxels();
  const ColumnMap map(size[u], size[v], decisions);
  const auto all = map.all();
  std::vector<std::uint8_t> trusted(all.size());
  std::vector<int> support(all.size()), surface(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!has_surface(all[i])) continue;
    std::vector<int> layers = supporting_layers(map, all[i]);
    support[i] = int(layers.size()) - 1;
    trusted[i] = support[i] >= kSupport;
    surface[i] = median(layers);
  }
  std::vector<ivec3> carved;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Decision& d = all[i];
    int end = d.bare;
    // What is consistent where it is bare stays, unless it stands alone.
    const bool open = d.outcome == Outcome::kUndecided || d.outcome == Outcome::kBetter ||
                      (d.outcome == Outcome::kKept && support[i] < kLonely);
    if (trusted[i] && d.outcome == Outcome::kBetter)
      end = surface[i];
    else if (open && !trusted[i])
      end = consensus_layer(map, trusted, d);
    for (int layer = d.bare; layer < end; ++layer) {
      ivec3 voxel;
      voxel[u] = d.column.x;
      voxel[v] = d.column.y;
      voxel[axis] = sign > 0 ? layer : size[axis] - 1 - layer;
      if (!bits.standing(voxel)) continue;
      bits.clear(voxel);
      carved.push_back(voxel);
    }
  }
  return carved;
}

}  // namespace photohull::carving
