#include "refine/view_groups.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/error.h"

namespace photohull::refine {
namespace {

using Members = std::vector<std::uint8_t>;  // by view: is it one?

int count(const Members& members) { return std::accumulate(members.begin(), members.end(), 0); }

int count_new(std::span<const int> views, const Members& members) {
  return int(std::ranges::count_if(views, [&](int v) { return !members[std::size_t(v)]; }));
}

void add(std::span<const int> views, Members& members) {
  for (const int v : views) members[std::size_t(v)] = 1;
}

std::vector<int> listed(const Members& members) {
  std::vector<int> out;
  for (std::size_t v = 0; v < members.size(); ++v)
    if (members[v]) out.push_back(int(v));
  return out;
}

/// How many of the surfels need each view.
std::vector<std::int64_t> count_uses(std::span<const std::uint32_t> surfels,
                                     std::span<const ViewChoice> choices, int views) {
  std::vector<std::int64_t> uses(static_cast<std::size_t>(views));
  for (const std::uint32_t i : surfels)
    for (const int v : choices[i].views) ++uses[std::size_t(v)];
  return uses;
}

/// Views of the surfel whose views are used most, and others by how much they are used.
Members most_used(std::span<const std::uint32_t> surfels, std::span<const ViewChoice> choices,
                  int views, int most) {
  const std::vector<std::int64_t> uses = count_uses(surfels, choices, views);
  const std::uint32_t seed = std::ranges::max(surfels, {}, [&](std::uint32_t i) {
    std::int64_t sum = 0;
    for (const int v : choices[i].views) sum += uses[std::size_t(v)];
    return sum;
  });
  Members members(static_cast<std::size_t>(views));
  add(choices[seed].views.span(), members);
  std::vector<int> order(static_cast<std::size_t>(views));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](int v) { return uses[std::size_t(v)]; });
  int room = most - count(members);
  for (const int v : order) {
    if (room <= 0 || uses[std::size_t(v)] == 0) break;
    room -= !members[std::size_t(v)];
    members[std::size_t(v)] = 1;
  }
  return members;
}

/// Surfels of one reference view, in pieces where their views are too many: as many in each as can
/// be.
std::vector<ViewGroup> pieces_of(std::vector<std::uint32_t> surfels,
                                 std::span<const ViewChoice> choices, int views, int most) {
  std::vector<ViewGroup> out;
  while (!surfels.empty()) {
    const Members members = most_used(surfels, choices, views, most);
    const auto left = std::stable_partition(surfels.begin(), surfels.end(), [&](std::uint32_t i) {
      return count_new(choices[i].views.span(), members) == 0;
    });
    ViewGroup piece;
    piece.surfels.assign(surfels.begin(), left);
    Members used(static_cast<std::size_t>(views));
    for (const std::uint32_t i : piece.surfels) add(choices[i].views.span(), used);
    piece.views = listed(used);
    out.push_back(std::move(piece));
    surfels.erase(surfels.begin(), left);
  }
  return out;
}

}  // namespace

std::vector<ViewGroup> group_by_views(std::span<const ViewChoice> choices, int views, int most) {
  PHOTOHULL_CHECK_OP(most, >=, ViewChoice::kMostViews);
  std::vector<std::vector<std::uint32_t>> by_reference(static_cast<std::size_t>(views));
  for (std::uint32_t i = 0; i < choices.size(); ++i)
    if (choices[i].comparable()) by_reference[std::size_t(choices[i].reference())].push_back(i);
  std::vector<ViewGroup> left;
  for (std::vector<std::uint32_t>& surfels : by_reference)
    for (ViewGroup& piece : pieces_of(std::move(surfels), choices, views, most))
      left.push_back(std::move(piece));
  std::vector<ViewGroup> out;
  Members members(static_cast<std::size_t>(views), 0);
  while (!left.empty()) {
    // The one that brings the fewest views besides those of the group, or of the group before.
    const auto next = std::ranges::min_element(
        left, {}, [&](const ViewGroup& piece) { return count_new(piece.views, members); });
    if (out.empty() || count(members) + count_new(next->views, members) > most) {
      if (!out.empty()) out.back().views = listed(members);
      members.assign(std::size_t(views), 0);
      out.emplace_back();
    }
    add(next->views, members);
    std::vector<std::uint32_t>& all = out.back().surfels;
    all.insert(all.end(), next->surfels.begin(), next->surfels.end());
    left.erase(next);
  }
  if (!out.empty()) out.back().views = listed(members);
  for (ViewGroup& group : out) std::ranges::sort(group.surfels);
  return out;
}

}  // namespace photohull::refine
