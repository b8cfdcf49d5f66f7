#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/grid.h"
#include "refine/kernels/label_space.h"

namespace photohull::refine::reference {
namespace {

/// A dense box around the bricks; what no brick holds takes no part.
class Lattice {
 public:
  explicit Lattice(std::span<const glm::ivec3> bricks) : low_(bricks[0]), size_(0) {
    glm::ivec3 high = bricks[0];
    for (const glm::ivec3& b : bricks) low_ = glm::min(low_, b), high = glm::max(high, b);
    size_ = (high - low_ + 1) * kBrickEdge;
    place_.assign(std::size_t(size_.x) * size_.y * size_.z, -1);
    for (std::size_t b = 0; b < bricks.size(); ++b)
      for (int i = 0; i < kBrickVoxels; ++i)
        place_[index((bricks[b] - low_) * kBrickEdge + glm::ivec3(i / 64, i / 8 % 8, i % 8))] =
            int(b) * kBrickVoxels + i;
  }

  glm::ivec3 size() const { return size_; }
  /// Of the bricks' list, or -1.
  int at(const glm::ivec3& v) const {
    if (glm::any(glm::lessThan(v, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(v, size_)))
      return -1;
    return place_[index(v)];
  }

 private:
  std::size_t index(const glm::ivec3& v) const {
    return (std::size_t(v.z) * size_.y + v.y) * size_.x + v.x;
  }
  glm::ivec3 low_, size_;
  std::vector<int> place_;
};

}  // namespace

std::vector<double> label_space(std::span<const glm::ivec3> bricks, std::span<const float> evidence,
                                int iterations) {
  PHOTOHULL_CHECK_OP(evidence.size(), ==, bricks.size() * kBrickVoxels);
  if (bricks.empty()) return {};
  const Lattice lattice(bricks);
  const glm::ivec3 n = lattice.size();
  const double rate = 0.288;
  std::vector<double> u(evidence.size()), ahead;
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = evidence[i] < 0 ? 1 : 0;
  ahead = u;
  std::vector<glm::dvec3> flow(u.size(), glm::dvec3(0));
  const auto each = [&](auto&& visit) {
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x)
          if (const int i = lattice.at({x, y, z}); i >= 0)
            visit(glm::ivec3(x, y, z), std::size_t(i));
  };
  for (int k = 0; k < iterations; ++k) {
    each([&](const glm::ivec3& v, std::size_t i) {
      glm::dvec3 difference(0);
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 next = v;
        ++next[axis];
        if (const int j = lattice.at(next); j >= 0)
          difference[axis] = ahead[std::size_t(j)] - ahead[i];
      }
      flow[i] += rate * difference;
      flow[i] /= std::max(1.0, glm::length(flow[i]));
    });
    each([&](const glm::ivec3& v, std::size_t i) {
      double divergence = 0;
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 before = v;
        --before[axis];
        divergence += flow[i][axis];
        if (const int j = lattice.at(before); j >= 0) divergence -= flow[std::size_t(j)][axis];
      }
      const double next = std::clamp(u[i] + rate * (divergence - double(evidence[i])), 0.0, 1.0);
      ahead[i] = 2 * next - u[i];
      u[i] = next;
    });
  }
  return u;
}

}  // namespace photohull::refine::reference
