// Which views a surfel is matched in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"

namespace photohull::refine {

/// Up to `kMost` views in an order, without memory of its own on the heap: there is a list a
/// surfel.
template <int kMost>
class ViewList {
 public:
  ViewList() = default;
  /// CHECKs that there are not more than fit.
  explicit ViewList(std::span<const int> views) {
    for (const int view : views) push_back(view);
  }

  void push_back(int view) {
    PHOTOHULL_CHECK_OP(count_, <, kMost);
    views_[std::size_t(count_++)] = view;
  }
  void clear() { count_ = 0; }

  int size() const { return count_; }
  bool empty() const { return count_ == 0; }
  int operator[](int i) const { return views_[std::size_t(i)]; }
  std::span<const int> span() const { return {views_.data(), std::size_t(count_)}; }
  auto begin() const { return span().begin(); }
  auto end() const { return span().end(); }

 private:
  std::array<int, kMost> views_{};
  int count_ = 0;
};

struct ViewChoice {
  static constexpr int kMostViews = 6, kMostHidden = 4;
  static constexpr int kCandidates = 16;  ///< worthiest views that the choice is made among

  /// The reference view, then those compared with it. None: the surfel is not matched.
  ViewList<kMostViews> views;
  /// The most frontal ones of those that face the surfel and that something hides it from.
  ViewList<kMostHidden> hidden;
  int seen = 0;  ///< views that see it, matched or not

  int reference() const { return views[0]; }
  std::span<const int> others() const { return views.span().subspan(1); }
  /// Are there enough views to compare them?
  bool comparable() const { return views.size() >= 2; }
};

/// Surfels whose views can be compared.
inline std::vector<std::uint32_t> comparable(std::span<const ViewChoice> choices) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < choices.size(); ++i)
    if (choices[i].comparable()) out.push_back(i);
  return out;
}

}  // namespace photohull::refine
