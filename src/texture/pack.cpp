// After the skyline heuristic of J. Jylänki, "A thousand ways to pack the bin", 2010 [Jylanki10].
#include "texture/pack.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "core/error.h"

namespace photohull::texture {
namespace {

constexpr int kLeastEdge = 64;

/// A page with the upper outline of what lies on it.
class Skyline {
 public:
  explicit Skyline(const glm::ivec2& page) : page_(page), steps_{{0, 0, page.x}} {}

  /// Nothing where there is no room.
  std::optional<glm::ivec2> place(const glm::ivec2& size) {
    std::size_t best = steps_.size();
    int best_y = page_.y;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const int y = height_over(i, size.x);
      if (y < 0 || y + size.y > page_.y || y >= best_y) continue;
      best = i;
      best_y = y;
    }
    if (best == steps_.size()) return std::nullopt;
    const glm::ivec2 at(steps_[best].x, best_y);
    cover(best, at, size);
    return at;
  }

 private:
  struct Step {
    int x, y, width;
  };

  /// Of a rectangle that begins at a step; negative where it would end beyond the page.
  int height_over(std::size_t first, int width) const {
    if (steps_[first].x + width > page_.x) return -1;
    int y = 0;
    for (std::size_t i = first; width > 0; ++i) {
      y = std::max(y, steps_[i].y);
      width -= steps_[i].width;
    }
    return y;
  }

  void cover(std::size_t first, const glm::ivec2& at, const glm::ivec2& size) {
    const int end = at.x + size.x;
    std::size_t last = first;
    while (last < steps_.size() && steps_[last].x + steps_[last].width <= end) ++last;
    if (last < steps_.size() && steps_[last].x < end) {
      steps_[last].width -= end - steps_[last].x;
      steps_[last].x = end;
    }
    const auto begin = steps_.begin() + std::ptrdiff_t(first);
    const auto next = steps_.erase(begin, steps_.begin() + std::ptrdiff_t(last));
    steps_.insert(next, {at.x, at.y + size.y, size.x});
  }

  glm::ivec2 page_;
  std::vector<Step> steps_;  // from left to right, without gaps
};

/// `pages`: as many as are allowed. False where that is too few.
bool place_all(std::span<const glm::ivec2> sizes, const std::vector<std::size_t>& order,
               std::uint32_t pages, Packed& out) {
  std::vector<Skyline> skylines;
  for (const std::size_t i : order) {
    std::optional<glm::ivec2> at;
    std::uint32_t page = 0;
    for (; page < skylines.size() && !at; ++page)
      if ((at = skylines[page].place(sizes[i]))) break;
    if (!at) {
      if (skylines.size() == pages) return false;
      skylines.emplace_back(out.page);
      at = skylines.back().place(sizes[i]);
      if (!at) return false;
    }
    out.place[i] = *at;
    out.on[i] = page;
  }
  out.pages = std::uint32_t(skylines.size());
  return true;
}

}  // namespace

Packed pack(std::span<const glm::ivec2> sizes, int most_edge) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sizes[a].y != sizes[b].y ? sizes[a].y > sizes[b].y : sizes[a].x > sizes[b].x;
  });
  std::int64_t area = 0;
  for (const glm::ivec2& size : sizes) area += std::int64_t(size.x) * size.y;
  Packed out{
      {}, 0, std::vector<glm::ivec2>(sizes.size()), std::vector<std::uint32_t>(sizes.size())};
  for (int edge = std::min(kLeastEdge, most_edge); edge <= most_edge; edge *= 2)
    for (const glm::ivec2 page : {glm::ivec2(edge, edge / 2), glm::ivec2(edge, edge)}) {
      out.page = page;
      if (std::int64_t(page.x) * page.y >= area && place_all(sizes, order, 1, out)) return out;
    }
  out.page = glm::ivec2(most_edge);
  PHOTOHULL_CHECK(place_all(sizes, order, 0xffffffffu, out));
  return out;
}

}  // namespace photohull::texture
