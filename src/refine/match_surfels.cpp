#include "refine/match_surfels.h"

#include <algorithm>
#include <vector>

namespace photohull::refine {
namespace {

constexpr std::size_t kPart = std::size_t(1) << 19;  // surfels that are matched at once

}  // namespace

Matches match_surfels(gpu::Context& context, const MatchingPhotographs& photographs,
                      const GridSpec& grid, const SurfelsAsked& asked,
                      const MatchRequest& request) {
  const std::size_t scores = request.textures_alone ? 0 : std::size_t(request.range.count);
  Matches all;
  all.range = request.range;
  all.scores.assign(asked.choices.size() * scores, kNoScore);
  all.texture.assign(asked.choices.size(), 1);
  const auto match_some = [&](const PatchMatcher& matcher, const HeldNumbers& numbers,
                              std::span<const std::uint32_t> indices) {
    std::vector<PatchSurfel> surfels;
    std::vector<glm::vec3> bends;
    std::vector<ViewChoice> views;
    for (const std::uint32_t i : indices) {
      surfels.push_back(asked.at(i));
      if (!asked.bends.empty()) bends.push_back(asked.bends[i]);
      views.push_back(numbers.of(asked.choices[i]));
    }
    const Matches part = request.textures_alone
                             ? matcher.textures(surfels, views)
                             : matcher.match(surfels, bends, views, request.range);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      all.texture[indices[k]] = part.texture[k];
      std::copy_n(part.scores.begin() + std::ptrdiff_t(k * scores), scores,
                  all.scores.begin() + std::ptrdiff_t(indices[k] * scores));
    }
    all.samples += part.samples;
  };
  photographs.for_each(asked.choices, [&](const projtex::Photographs& held,
                                          std::span<const std::uint32_t> indices,
                                          const HeldNumbers& numbers) {
    const PatchMatcher matcher(context, held.images, projtex::to_grid(held.cameras, grid),
                               patch_rules(request.options, held.noise_sigma),
                               "refine_match_patches");
    for (std::size_t first = 0; first < indices.size(); first += kPart)
      match_some(matcher, numbers, indices.subspan(first, std::min(kPart, indices.size() - first)));
  });
  return all;
}

}  // namespace photohull::refine
