// Masks moved to where the photographs have their outlines.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "carving/confirm_lines.h"
#include "core/error.h"
#include "core/option_word.h"
#include "masks/mask_bias.h"
#include "masks/mask_lines.h"
#include "masks/photo_lines.h"
#include "masks/silhouette.h"
#include "pipeline/silhouette_steps.h"
#include "pipeline/subject.h"
#include "projtex/gpu_views.h"

namespace photohull::pipeline::silhouettes {
namespace {

constexpr double kPartialPixel = 1;   // eaten together with the whole ones
constexpr std::size_t kRestored = 6;  // pixels a view: a line, as photo_lines.h counts them

std::string how_to_refuse() {
  return concat(" (", option_word("mask_offset", "0"), " takes the masks as they are)");
}

std::vector<std::vector<LinePoint>> lines_in_photographs(const std::vector<PreparedView>& views,
                                                         const PhotoLineOptions& options) {
  std::vector<std::vector<LinePoint>> found(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    const PreparedView& view = views[i];
    if (!view.mask.empty() && !view.silhouette.likelihood)
      found[i] = find_photo_lines(view, view.silhouette.distance, options);
  });
  return found;
}

/// Parts twice as wide as what was taken from every outline are not in the masks any more. Were
/// there such lines in most views?
bool restore_eaten(double eaten, const SilhouetteJob& job, std::vector<PreparedView>& views,
                   SilhouetteFindings& findings, Progress& progress) {
  PhotoLineOptions options;
  options.noise_sigma = job.photographs.noise_sigma;
  options.widest = std::min(2 * eaten + kPartialPixel, PhotoLineOptions::kWidest);
  carving::ConfirmOptions confirm;
  confirm.continues_mask = options.widest;
  const std::vector<Camera> cameras = projtex::cameras_of(views);
  const carving::ConfirmedLines confirmed =
      carving::confirm_lines(job.box, cameras, silhouettes_of(views),
                             lines_in_photographs(views, options), confirm, &progress);
  findings.thin.restored_pixels = std::int64_t(confirmed.places.size());
  if (confirmed.places.empty()) return false;
  const bool restored = confirmed.places.size() >= kRestored * views.size();
  if (restored)
    progress.warn(concat("the masks lack thin parts that the photographs show (",
                         confirmed.places.size(), " px of them in all views): they were put back",
                         how_to_refuse()));
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    PreparedView& view = views[i];
    if (view.mask.empty() || view.silhouette.likelihood) return;
    std::vector<glm::dvec2> places;
    for (const glm::dvec3& p : confirmed.places)
      if (const auto pixel = cameras[i].project(p); pixel && cameras[i].on_image(*pixel))
        places.push_back(*pixel);
    restore_lines(confirmed.lines[i], places, view.silhouette.distance, view);
    view.silhouette.distance = silhouette_distance(view.mask);
  });
  return restored;
}

/// Pixels by which outlines are to be moved outward.
double measured_offset(const std::vector<PreparedView>& views) {
  const MaskBias bias = measure_mask_bias(views, distances_of(views));
  return bias.counts() ? bias.pixels : 0;
}

}  // namespace

bool correct_masks(const SilhouetteJob& job, std::vector<PreparedView>& views,
                   SilhouetteFindings& findings, Progress& progress) {
  const std::optional<double>& given = job.options.mask_offset;
  // The user counts in the files' pixels.
  const double scale = job.photographs.largest_scale;
  const double offset = given ? *given * scale : measured_offset(views);
  findings.mask_offset = offset / scale;
  if (offset == 0) return false;
  if (!given)
    progress.warn(
        concat("the masks are about ", std::round(10 * std::abs(findings.mask_offset)) / 10,
               " px too ", offset > 0 ? "small" : "large",
               ": outlines are taken from where the photographs' edges are", how_to_refuse()));
  for (PreparedView& view : views)
    if (!view.mask.empty()) move_outline(offset, view.mask, view.silhouette.distance);
  return offset > 0 && restore_eaten(offset, job, views, findings, progress);
}

}  // namespace photohull::pipeline::silhouettes
