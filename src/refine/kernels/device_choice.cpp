#include "refine/kernels/device_choice.h"

#include <vector>

namespace photohull::refine {
namespace {

static_assert(ViewChoice::kMostViews == shaders::kMatchViews);
static_assert(ViewChoice::kMostHidden == shaders::kHiddenViews);
static_assert(ViewChoice::kCandidates == shaders::kMatchCandidates);

constexpr int kFirst = 4;  // views that MatchChoice::first holds

}  // namespace

gpu::Buffer to_device(std::span<const ViewChoice> choices, std::span<const std::uint32_t> indices) {
  std::vector<shaders::MatchChoice> out;
  out.reserve(indices.size());
  for (const std::uint32_t i : indices) {
    const ViewList<ViewChoice::kMostViews>& views = choices[i].views;
    shaders::MatchChoice choice{glm::ivec4(-1), {-1, -1, 0, views.size()}, glm::ivec4(-1)};
    for (int k = 0; k < views.size(); ++k)
      (k < kFirst ? choice.first[k] : choice.second[k - kFirst]) = views[k];
    out.push_back(choice);
  }
  return gpu::Buffer::of(out);
}

ViewChoice from_device(const shaders::MatchChoice& choice) {
  ViewChoice out;
  out.seen = choice.second.z;
  for (int k = 0; k < choice.second.w; ++k)
    out.views.push_back(k < kFirst ? choice.first[k] : choice.second[k - kFirst]);
  for (int k = 0; k < ViewChoice::kMostHidden && choice.hidden[k] >= 0; ++k)
    out.hidden.push_back(choice.hidden[k]);
  return out;
}

}  // namespace photohull::refine
