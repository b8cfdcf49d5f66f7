#include "refine/kernels/device_choice.h"

#include <algorithm>
#include <vector>

namespace photohull::refine {
namespace {

static_assert(ViewChoice::kMostViews == shaders::kMatchViews);
static_assert(ViewChoice::kMostHidden == shaders::kHiddenViews);
static_assert(ViewChoice::kCandidates == shaders::kMatchCandidates);

}  // namespace

gpu::Buffer to_device(std::span<const ViewChoice> choices, std::span<const std::uint32_t> indices) {
  std::vector<shaders::MatchChoice> out;
  out.reserve(indices.size());
  for (const std::uint32_t i : indices) {
    const ViewList<ViewChoice::kMostViews>& views = choices[i].views;
    shaders::MatchChoice choice{};
    std::ranges::fill(choice.views, -1);
    std::ranges::fill(choice.hidden, -1);
    std::ranges::copy(views, choice.views);
    choice.count = views.size();
    out.push_back(choice);
  }
  return gpu::Buffer::of(out);
}

ViewChoice from_device(const shaders::MatchChoice& choice) {
  ViewChoice out;
  out.seen = choice.seen;
  for (int k = 0; k < choice.count; ++k) out.views.push_back(choice.views[k]);
  for (int k = 0; k < ViewChoice::kMostHidden && choice.hidden[k] >= 0; ++k)
    out.hidden.push_back(choice.hidden[k]);
  return out;
}

}  // namespace photohull::refine
