// Distances, lines, and room for what is not known better.
#include "pipeline/silhouette_steps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cameras/diagnose.h"
#include "cameras/look_at_cameras.h"
#include "carving/missing_parts.h"
#include "core/error.h"
#include "masks/mask_bias.h"
#include "masks/mask_lines.h"
#include "masks/photographed_mask.h"
#include "masks/silhouette.h"
#include "pipeline/rounded_pixels.h"
#include "pipeline/subject.h"
#include "pipeline/tuning.h"
#include "projtex/gpu_views.h"

namespace photohull::pipeline::silhouettes {
namespace {

constexpr double kUnexplained = 0.02;   // of the foreground: more is told
constexpr double kDoubtedEvidence = 1;  // pixels (docs/design/decisions/0030)

void warn_of_room(const std::vector<OutlineRoom>& room, Progress& progress) {
  const auto worst = std::max_element(
      room.begin(), room.end(), [](const auto& a, const auto& b) { return a.pixels < b.pixels; });
  const std::size_t count = room.size();
  progress.warn(concat("the ", count == 1 ? "outline" : "outlines", " of ", count,
                       count == 1 ? " view is" : " views are", " off what the others say (most in ",
                       worst->view, ", by about ", hundredths(worst->pixels),
                       " px): they carve with as much room (check these cameras and masks)"));
}

void count_explained(std::span<const carving::ForegroundCounts> found,
                     const std::vector<PreparedView>& views, ThinFindings& counts) {
  double worst = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const carving::ForegroundCounts& v = found[i];
    counts.looked_at += v.looked_at, counts.unexplained += v.unexplained, counts.placed += v.placed;
    const double share = double(v.unexplained - v.placed) / std::max(v.looked_at, 1);
    if (share > worst) worst = share, counts.worst_view = views[i].name;
  }
}

/// Were masks made, by this job or by the program that wrote the scene?
bool were_made(const SilhouetteJob& job, const std::vector<PreparedView>& views) {
  return job.photographs.mask_confidence < 1 ||
         std::ranges::any_of(views, [](const PreparedView& v) { return v.source.mask_made; });
}

}  // namespace

void measure_distances(std::vector<PreparedView>& views) {
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!views[i].mask.empty()) views[i].silhouette.distance = silhouette_distance(views[i].mask);
  });
}

Outlines trace_outlines(std::vector<PreparedView>& views) {
  Outlines outlines(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    const Mask mask = photographed_mask(views[i].image, views[i].mask);
    std::vector<LinePoint>& lines = views[i].silhouette.lines;
    lines = find_lines(mask);
    if (views[i].silhouette.likelihood) lines = sure_lines(mask, std::move(lines));
    outlines[i] = outline_of(mask, lines);
  });
  return outlines;
}

Room bear_disagreement(const SilhouetteJob& job, const std::vector<PreparedView>& views,
                       const Outlines& outlines, bool restored, SilhouetteFindings& findings,
                       Progress& progress) {
  Room room{std::vector<double>(views.size(), 0), 0};
  if (job.options.views_may_miss || !any_mask(views)) return room;
  const std::vector<Camera> cameras = projtex::cameras_of(views);
  // What was taken from the tips of thin parts is no error of a view as a whole.
  if (!restored) room.pixels = outlines_off(fit_silhouettes(cameras, outlines));
  const double usual = tangent_disagreement(cameras, outlines);
  if (usual > kSuspiciousTangents) room.full_evidence = usual;
  for (std::size_t i = 0; i < room.pixels.size(); ++i)
    if (room.pixels[i] > 0) findings.outline_room.push_back({views[i].name, room.pixels[i]});
  if (!findings.outline_room.empty()) warn_of_room(findings.outline_room, progress);
  return room;
}

void give_room(const Room& room, std::vector<PreparedView>& views, SilhouetteFindings& findings) {
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    ViewSilhouette& s = views[i].silhouette;
    const double pixels = room.pixels[i];
    if (views[i].mask.empty() || (s.lines.empty() && pixels == 0)) return;
    s.widened = views[i].mask;
    widen_lines(s.lines, s.widened);
    s.distance = silhouette_distance(s.widened);
    if (pixels > 0) move_outline(pixels, s.widened, s.distance);
  });
  for (const PreparedView& view : views)
    findings.thin.line_pixels += std::int64_t(view.silhouette.lines.size());
}

double explain_foreground(const SilhouetteJob& job, double full_evidence,
                          std::vector<PreparedView>& views, SilhouetteFindings& findings,
                          Progress& progress) {
  if (job.options.views_may_miss || !any_mask(views)) return full_evidence;
  const std::vector<Camera> cameras = projtex::cameras_of(views);
  const carving::MissingParts found = carving::find_missing_parts(
      job.box, cameras, silhouettes_of(views), tuned(job.options).missing, &progress);
  ThinFindings& counts = findings.thin;
  count_explained(found.views, views, counts);
  const bool made = were_made(job, views);
  const carving::Mending& mending = made ? carving::kMendGaps : carving::kMendThinParts;
  if (made) full_evidence = std::max(full_evidence, kDoubtedEvidence);
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    ViewSilhouette& s = views[i].silhouette;
    Mask mask = s.widened.empty() ? views[i].mask : s.widened;
    if (!carving::mend_silhouette(found.parts, cameras[i], s.distance, mending, mask)) return;
    s.distance = silhouette_distance(mask);
    s.widened = std::move(mask);
  });
  if (full_evidence > 0)
    for (PreparedView& view : views) {
      ViewSilhouette& s = view.silhouette;
      if (!view.mask.empty() && s.likelihood)
        weigh_by_certainty(s.widened.empty() ? view.mask : s.widened, s.distance);
    }
  // Masks that this job made show likelihoods, too, and other views are free to tell otherwise.
  if (job.photographs.mask_confidence < 1) return full_evidence;
  const auto left = double(counts.unexplained - counts.placed);
  if (left > kUnexplained * double(counts.looked_at))
    progress.warn(concat("the masks show parts (",
                         std::round(1000 * left / double(counts.looked_at)) / 10,
                         " % of their foreground, most in ", counts.worst_view,
                         ") that too many other masks leave out: these are not in the model"));
  return full_evidence;
}

}  // namespace photohull::pipeline::silhouettes
