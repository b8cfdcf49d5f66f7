#include "pipeline/subject.h"

#include <algorithm>

#include "pipeline/methods/method.h"
#include "pipeline/methods/sampler.h"

namespace photohull::pipeline {

bool any_mask(std::span<const PreparedView> views) {
  return std::any_of(views.begin(), views.end(),
                     [](const PreparedView& v) { return !v.mask.empty(); });
}

std::vector<carving::Silhouette> silhouettes_of(std::span<const PreparedView> views) {
  std::vector<carving::Silhouette> out;
  for (const PreparedView& view : views) {
    const ViewSilhouette& s = view.silhouette;
    if (view.mask.empty())
      out.push_back({&view.mask});
    else
      out.push_back({s.widened.empty() ? &view.mask : &s.widened, &s.distance, &s.lines,
                     s.likelihood, &view.image});
  }
  return out;
}

std::vector<const SilhouetteDistance*> distances_of(std::span<const PreparedView> views) {
  std::vector<const SilhouetteDistance*> out;
  for (const PreparedView& view : views) {
    const SilhouetteDistance& distance = view.silhouette.distance;
    out.push_back(distance.pixels.empty() ? nullptr : &distance);
  }
  return out;
}

std::vector<SourceView> sources_of(std::span<const PreparedView> views) {
  std::vector<SourceView> out;
  for (const PreparedView& view : views) out.push_back(view.source);
  return out;
}

bool masks_are_needed(const ReconstructOptions& options, std::span<const PreparedView> views) {
  return !method_of(options).from_hull || sampler_of(options) != projtex::Sampler::kMipmap ||
         std::any_of(views.begin(), views.end(), [](const PreparedView& view) {
           return !view.silhouette.lines.empty() || !view.silhouette.widened.empty();
         });
}

std::vector<PreparedView> without_masks(std::vector<PreparedView> views) {
  for (PreparedView& view : views) std::vector<std::uint8_t>().swap(view.mask.coverage);
  return views;
}

void drop_distances(std::vector<PreparedView>& views) {
  for (PreparedView& view : views) std::vector<float>().swap(view.silhouette.distance.pixels);
}

void keep_only_photograph(int kept, std::vector<PreparedView>& views) {
  for (int i = 0; i < int(views.size()); ++i)
    if (i != kept) std::vector<std::uint8_t>().swap(views[std::size_t(i)].image.bytes);
}

}  // namespace photohull::pipeline
