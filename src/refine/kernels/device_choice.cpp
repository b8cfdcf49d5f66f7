#include "refine/kernels/device_choice.h"

#include <algorithm>
#include <vector>

namespace photohull::refine {
namespace {

static_assert(ViewChoice::kMostViews == shaders::kMatchViews);
static_assert(ViewChoice::kMostHidden == shaders::kHiddenViews);
static_assert(ViewChoice::kCandidates == shaders::kMatchCandidates);

shaders::MatchChoice to_device(const ViewChoice& choice) {
  shaders::MatchChoice out{};
  std::ranges::fill(out.views, -1);
  std::ranges::fill(out.hidden, -1);
  std::ranges::copy(choice.views, out.views);
  out.count = choice.views.size();
  return out;
}

}  // namespace

gpu::Buffer to_device(std::span<const ViewChoice> choices) {
  std::vector<shaders::MatchChoice> out;
  out.reserve(choices.size());
  for (const ViewChoice& choice : choices) out.push_back(to_device(choice));
  return gpu::Buffer::of(out);
}

gpu::Buffer to_device(std::span<const ViewChoice> choices, std::span<const std::uint32_t> indices) {
  std::vector<shaders::MatchChoice> out;
  out.reserve(indices.size());
  for (const std::uint32_t i : indices) out.push_back(to_device(choices[i]));
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
