#include "pipeline/prepare_scene.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/error.h"
#include "core/option_word.h"
#include "masks/torn_masks.h"
#include "photo/noise.h"
#include "pipeline/checks.h"
#include "pipeline/image_scale.h"
#include "pipeline/mask_cache.h"
#include "pipeline/mask_policy.h"
#include "pipeline/place_lattice.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {
namespace {

double median_noise(std::span<const PreparedView> views) {
  std::vector<double> values(views.size());
  tbb::parallel_for(std::size_t(0), views.size(),
                    [&](std::size_t i) { values[i] = estimate_image_noise(views[i].image); });
  std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
  return values[values.size() / 2];
}

bool was_given(const MaskJudgement& mask) {
  return mask.source == "mask files" || mask.source == "alpha channels";
}

/// What is decoded, and the scene as it was read.
struct Decoded {
  Scene scene;
  PreparedViews prepared;
};

Decoded decode(const Photographs& photographs, const Scene& full, std::span<const double> scales,
               const MaskFinder& masks, Progress& progress) {
  PrepareOptions options;
  options.masks = mask_policy(photographs.load.masks);
  options.strict = photographs.load.strict;
  Decoded out{full, {}};
  scale_scene(scales, out.scene);
  out.prepared = prepare_views(out.scene, reduced_loader(photographs.reader, full, scales), options,
                               progress, masks);
  return out;
}

/// The same, larger where the object turns out to be small in its box: --resolution will count
/// along the object's own box, whose voxels need finer pixels; and there is more memory for those
/// than in all of the box.
Decoded decode_as_needed(const Photographs& photographs, ReadScene& read,
                         const ReconstructOptions& options, Progress& progress) {
  const std::vector<double>& scales = read.reading.scales;
  MaskFinder masks = find_masks;
  if (!options.checkpoint.empty())
    masks = find_masks_once(options.checkpoint, options.fresh, progress);
  Decoded out = decode(photographs, read.scene, scales, masks, progress);
  if (options.image_scale || !(options.resolution || read.reading.short_of_memory) ||
      *std::min_element(scales.begin(), scales.end()) == 1)
    return out;
  const std::optional<Box> box = smaller_box(options, *read.scene.box, out.prepared.views);
  if (!box) return out;
  Reading reading = choose_reading(photographs, read.scene, *box, options, progress);
  const bool same = reading.scales == read.reading.scales;
  read.reading = std::move(reading);
  if (same) return out;
  out = {};
  return decode(photographs, read.scene, read.reading.scales, masks, progress);
}

/// The background of a photograph taken from within the box is what is looked for.
void forget_masks_made_within(const Scene& scene, std::vector<PreparedView>& views,
                              Progress& progress) {
  const std::size_t within = cameras_within(*scene.box, scene.views);
  const auto made = [](const PreparedView& view) { return view.silhouette.likelihood; };
  if (within == 0 || std::none_of(views.begin(), views.end(), made)) return;
  for (PreparedView& view : views) {
    if (made(view)) view.mask = {};
    view.silhouette.likelihood = false;
  }
  progress.warn(concat(within, within == 1 ? " camera stands" : " cameras stand",
                       " inside the box: masks made from the background are not used"));
}

/// Returns how many there were.
int mend_given_masks(std::span<const MaskJudgement> masks, std::vector<PreparedView>& views,
                     Progress& progress) {
  std::vector<MendedMask> mended(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    // Masks made from the photograph's colours have nothing to learn from them.
    if (was_given(masks[i]) && !views[i].mask.empty())
      mended[i] = mend_mask(views[i].image, views[i].mask);
  });
  const auto worst = std::max_element(
      mended.begin(), mended.end(), [](const auto& a, const auto& b) { return a.share < b.share; });
  const auto torn =
      std::count_if(mended.begin(), mended.end(), [](const auto& m) { return m.holes; });
  if (torn > 0)
    progress.warn(
        concat(torn, torn == 1 ? " mask has" : " masks have",
               " holes or bites where the photographs show the object's colours (most in ",
               views[std::size_t(worst - mended.begin())].name, ", ",
               std::round(1000 * worst->share) / 10, " % of it): they were filled (",
               option_word("mask_holes", "keep"), " takes the masks as they are)"));
  return int(torn);
}

}  // namespace

PreparedScene prepare_scene(const Photographs& photographs, ReadScene read,
                            const ReconstructOptions& options, Progress& progress) {
  Decoded decoded = decode_as_needed(photographs, read, options, progress);
  const std::vector<double>& scales = read.reading.scales;
  PreparedViews& prepared = decoded.prepared;
  PreparedScene out{
      std::move(decoded.scene), std::move(prepared.views), {}, read.reading.held_bytes};
  ViewFindings& found = out.findings;
  found.views = int(out.views.size());
  found.left_out = out.scene.left_out;
  found.smallest_scale = *std::min_element(scales.begin(), scales.end());
  found.largest_scale = *std::max_element(scales.begin(), scales.end());
  found.noise_sigma =
      std::max(options.noise ? *options.noise / 255 * found.largest_scale : median_noise(out.views),
               kRoundingNoise);
  found.matched_scale = *std::ranges::min_element(read.reading.matched);
  for (const std::string& text : prepared.warnings) progress.warn(text);
  std::map<std::string, std::pair<double, double>> scales_of;  // read and matched
  for (std::size_t i = 0; i < scales.size(); ++i)
    scales_of[read.scene.views[i].name] = {scales[i], read.reading.matched[i]};
  found.mask_source = prepared.mask_source;
  found.mask_confidence = prepared.mask_confidence;
  for (std::size_t i = 0; i < out.views.size(); ++i) {
    PreparedView& view = out.views[i];
    view.source = out.scene.views[i];
    std::tie(view.scale, view.matched_scale) = scales_of.at(view.name);
    view.silhouette.likelihood = !view.mask.empty() && !was_given(prepared.masks[i]);
    found.masks.push_back({view.name, prepared.masks[i].source, prepared.masks[i].confidence});
  }
  forget_masks_made_within(out.scene, out.views, progress);
  if (!options.keep_mask_holes)
    found.masks_mended = mend_given_masks(prepared.masks, out.views, progress);
  return out;
}

}  // namespace photohull::pipeline
