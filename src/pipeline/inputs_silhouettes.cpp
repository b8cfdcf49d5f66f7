// Inputs: silhouettes, and what contradicts them.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "assess/wrong_views.h"
#include "cameras/diagnose.h"
#include "cameras/refine_cameras.h"
#include "carving/confirm_lines.h"
#include "carving/missing_parts.h"
#include "core/error.h"
#include "core/left_out.h"
#include "masks/mask_bias.h"
#include "masks/mask_lines.h"
#include "masks/photo_lines.h"
#include "pipeline/inputs.h"
#include "pipeline/self_check.h"
#include "pipeline/tuning.h"
#include "views/sharpness.h"

namespace photohull::pipeline {
namespace {

// Sharpness beside neighbours below which a view is strongly blurred: 0.80 and more in bunny,
// fandisk, trellis, glazed, plaster, armadillo, tabletop, both rings and fountain; 0.79 to 0.85 in
// views moved by 4 pixels, 0.69 to 0.74 by 8, 0.63 to 0.69 by 16 (folds and arch,
// docs/measurements/stability.md). Without silhouettes views are missed more: leaving out those of
// 8 pixels costs folds 4 points of F at 0.25 %, leaving out those of 16 gains one.
constexpr double kBlurred = 0.75, kBlurredWithoutMasks = 0.69;
constexpr std::size_t kMostNamed = 5;
constexpr double kUnexplained = 0.02;  // of the foreground: more is told
constexpr double kPartialPixel = 1;    // eaten together with the whole ones
constexpr std::size_t kRestored = 6;   // pixels a view: a line, as photo_lines.h counts them
constexpr double kFarOff = 0.005;      // of the image's longer side: this view is wrong

/// Views whose outlines' tangents are far from all others', who agree; none where these are more
/// than a quarter.
std::vector<int> views_off_tangents(std::span<const View> views, std::span<const ViewFit> fits) {
  std::vector<int> off;
  std::size_t known = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const Intrinsics& k = views[i].camera.intrinsics;
    known += fits[i].count > 0;
    if (fits[i].disagrees && fits[i].residual > kFarOff * std::max(k.width, k.height))
      off.push_back(int(i));
  }
  return 4 * off.size() > known ? std::vector<int>() : off;
}

}  // namespace

bool Inputs::any_mask() const {
  return std::any_of(views.begin(), views.end(), [](const View& v) { return !v.mask.empty(); });
}

void Inputs::measure_silhouettes() {
  silhouettes.resize(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!views[i].mask.empty()) silhouettes[i] = silhouette_distance(views[i].mask);
  });
}

/// Masks that are all too small carve the object itself away.
void Inputs::correct_masks() {
  // The user counts in the files' pixels.
  double offset = options_.mask_offset.value_or(0) * report_.largest_scale;
  if (!options_.mask_offset) {
    const MaskBias bias = measure_mask_bias(views, silhouettes);
    if (bias.counts()) offset = bias.pixels;
  }
  const double in_files = offset / report_.largest_scale;
  report_.mask_offset = in_files;
  if (offset == 0) return;
  if (!options_.mask_offset)
    warn(concat("the masks are about ", std::round(10 * std::abs(in_files)) / 10, " px too ",
                offset > 0 ? "small" : "large",
                ": outlines are taken from where the photographs' edges are (--mask-offset 0 "
                "takes the masks as they are)"));
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!views[i].mask.empty()) move_outline(offset, views[i].mask, silhouettes[i]);
  if (offset > 0) restore_eaten(offset);
}

/// Parts twice as wide as what was taken from every outline are not in the masks any more.
void Inputs::restore_eaten(double eaten) {
  PhotoLineOptions options;
  options.noise_sigma = report_.noise_sigma;
  options.widest = std::min(2 * eaten + kPartialPixel, PhotoLineOptions::kWidest);
  std::vector<std::vector<LinePoint>> found(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!views[i].mask.empty() && !made_masks_.contains(views[i].name))
      found[i] = find_photo_lines(views[i], silhouettes[i], options);
  });
  carving::ConfirmOptions confirm;
  confirm.continues_mask = options.widest;
  lines.assign(views.size(), {});
  const carving::ConfirmedLines confirmed = carving::confirm_lines(
      *scene.box, cameras, silhouettes_of_views(), std::move(found), confirm, &progress_);
  report_.thin.restored_pixels = std::int64_t(confirmed.places.size());
  if (confirmed.places.empty()) return;
  restored_ = confirmed.places.size() >= kRestored * views.size();
  if (restored_)
    warn(concat("the masks lack thin parts that the photographs show (", confirmed.places.size(),
                " px of them in all views): they were put back (--mask-offset 0 takes the masks as "
                "they are)"));
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty() || made_masks_.contains(views[i].name)) return;
    std::vector<glm::dvec2> places;
    for (const glm::dvec3& p : confirmed.places)
      if (const auto pixel = cameras[i].project(p); pixel && cameras[i].on_image(*pixel))
        places.push_back(*pixel);
    restore_lines(confirmed.lines[i], places, silhouettes[i], views[i]);
    silhouettes[i] = silhouette_distance(views[i].mask);
  });
}

void Inputs::trace_outlines() {
  lines.assign(views.size(), {});
  outlines_.assign(views.size(), {});
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    lines[i] = find_lines(views[i].mask);
    if (made_masks_.contains(views[i].name))
      lines[i] = sure_lines(views[i].mask, std::move(lines[i]));
    outlines_[i] = outline_of(views[i].mask, lines[i]);
  });
}

/// One view that is far off carves away what all others have.
void Inputs::leave_out_wrong_views() {
  if (!options_.keep_views)
    leave_out(
        views_off_tangents(views, fit_silhouettes(cameras, outlines_)),
        "its outline is not where the other views' outlines say (check its camera and its mask)");
  const assess::SilhouetteConsistency found =
      assess::find_wrong_views(*scene.box, cameras, pointers(silhouettes));
  contradiction = options_.keep_views ? found.uncovered : found.uncovered_left;
  if (!options_.keep_views)
    leave_out(found.wrong,
              "without it the other views' silhouettes agree (check its camera and its mask)");
  common_error = assess::find_common_error(cameras, outlines_);
}

/// The outline of a view that is off by a pixel would carve a pixel off the object, whatever all
/// others show. So it gets as much room as outlines tell that it is off.
void Inputs::bear_disagreement() {
  room_.assign(views.size(), 0);
  if (options_.views_may_miss || !any_mask()) return;
  // What was taken from the tips of thin parts is no error of a view as a whole.
  if (!restored_) room_ = outlines_off(fit_silhouettes(cameras, outlines_));
  const double usual = tangent_disagreement(cameras, outlines_);
  if (usual > kSuspiciousTangents) report_.full_evidence = full_evidence = usual;
  for (std::size_t i = 0; i < room_.size(); ++i)
    if (room_[i] > 0) report_.outline_room.push_back({views[i].name, room_[i]});
  if (report_.outline_room.empty()) return;
  const auto worst =
      std::max_element(report_.outline_room.begin(), report_.outline_room.end(),
                       [](const auto& a, const auto& b) { return a.pixels < b.pixels; });
  const std::size_t count = report_.outline_room.size();
  warn(concat("the ", count == 1 ? "outline" : "outlines", " of ", count,
              count == 1 ? " view is" : " views are", " off what the others say (most in ",
              worst->view, ", by about ", hundredths(worst->pixels),
              " px): they carve with as much room (check these cameras and masks)"));
}

void Inputs::widen_lines() {
  widened.assign(views.size(), {});
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    if (lines[i].empty() && room_[i] == 0) return;
    widened[i] = views[i].mask;
    photohull::widen_lines(lines[i], widened[i]);
    silhouettes[i] = silhouette_distance(widened[i]);
    if (room_[i] > 0) move_outline(room_[i], widened[i], silhouettes[i]);
  });
  for (const auto& list : lines) report_.thin.line_pixels += std::int64_t(list.size());
}

void Inputs::forget_masks() {
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!lines[i].empty() || !widened[i].empty()) return;
  for (View& view : views) std::vector<std::uint8_t>().swap(view.mask.coverage);
}

std::vector<carving::Silhouette> Inputs::silhouettes_of_views() const {
  std::vector<carving::Silhouette> out;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Mask& mask = views[i].mask;
    if (mask.empty())
      out.push_back({&mask});
    else
      out.push_back({i >= widened.size() || widened[i].empty() ? &mask : &widened[i],
                     &silhouettes[i], &lines[i], made_masks_.contains(views[i].name)});
  }
  return out;
}

void Inputs::explain_foreground() {
  if (options_.views_may_miss || !any_mask()) return;
  const carving::MissingOptions missing = tuned(options_).missing;
  const carving::MissingParts found =
      carving::find_missing_parts(*scene.box, cameras, silhouettes_of_views(), missing, &progress_);
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    Mask mask = widened[i].empty() ? views[i].mask : widened[i];
    if (!carving::mend_silhouette(found.parts, cameras[i], silhouettes[i], mask)) return;
    silhouettes[i] = silhouette_distance(mask);
    widened[i] = std::move(mask);
  });
  for (std::size_t i = 0; i < views.size() && full_evidence > 0; ++i)
    if (!views[i].mask.empty() && made_masks_.contains(views[i].name))
      weigh_by_certainty(widened[i].empty() ? views[i].mask : widened[i], silhouettes[i]);
  ThinReport& counts = report_.thin;
  double worst = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const carving::ForegroundCounts& v = found.views[i];
    counts.looked_at += v.looked_at, counts.unexplained += v.unexplained, counts.placed += v.placed;
    const double share = double(v.unexplained - v.placed) / std::max(v.looked_at, 1);
    if (share > worst) worst = share, counts.worst_view = views[i].name;
  }
  // Masks that were made show likelihoods, too, and other views are free to tell otherwise.
  if (report_.mask_confidence < 1) return;
  const auto left = double(counts.unexplained - counts.placed);
  if (left > kUnexplained * double(counts.looked_at))
    warn(concat("the masks show parts (", std::round(1000 * left / double(counts.looked_at)) / 10,
                " % of their foreground, most in ", counts.worst_view,
                ") that too many other masks leave out: these are not in the model"));
}

/// The views whose outlines contradict the others', in ascending order; where the camera is known
/// to be right, the mask alone.
void Inputs::leave_out(std::span<const int> wrong, const std::string& why) {
  for (auto i = wrong.rbegin(); i != wrong.rend(); ++i) {
    const std::string name = views[*i].name;
    if (right_cameras_.contains(name)) {
      warn(concat("the mask of ", name, " is left out: ", why,
                  "; the view stays, for features say that its camera is right"));
      report_.masks_left_out.push_back(name);
      views[*i].mask = {};
      silhouettes[*i] = {};
      lines[*i] = {};
      outlines_[*i] = {};
      continue;
    }
    warn(concat("view ", name, " is left out: ", why));
    drop_view(*i);
  }
}

void Inputs::drop_view(int index) {
  report_.left_out.push_back(views[index].name);
  views.erase(views.begin() + index);
  scene.views.erase(scene.views.begin() + index);
  cameras.erase(cameras.begin() + index);
  silhouettes.erase(silhouettes.begin() + index);
  if (!lines.empty()) lines.erase(lines.begin() + index);
  if (!outlines_.empty()) outlines_.erase(outlines_.begin() + index);
}

void Inputs::measure_sharpness() {
  const std::vector<double> sharpness =
      relative_sharpness(views, scene.box.value(), report_.noise_sigma);
  const double least = any_mask() ? kBlurred : kBlurredWithoutMasks;
  std::vector<int> blurred;
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].sharpness = sharpness[i];
    report_.sharpness.emplace_back(views[i].name, sharpness[i]);
    if (sharpness[i] < least) blurred.push_back(int(i));
  }
  const std::size_t left = views.size() - blurred.size();
  if (blurred.empty() || options_.keep_views) return;
  std::string names;
  for (std::size_t i = 0; i < std::min(blurred.size(), kMostNamed); ++i)
    names += concat(i ? ", " : "", views[std::size_t(blurred[i])].name);
  if (blurred.size() > kMostNamed) names += ", ...";
  const bool enough =
      left >= kFewestRemaining && double(left) >= kLeastRemainingShare * double(views.size());
  warn(concat(blurred.size(), blurred.size() == 1 ? " view is" : " views are",
              " blurred beside the others", enough ? ", and left out" : "", ": ", names,
              enough ? " (--keep-views keeps them)"
                     : "; too few would remain without them, so they stay: photograph again"));
  if (!enough) return;
  for (auto i = blurred.rbegin(); i != blurred.rend(); ++i) drop_view(*i);
}

}  // namespace photohull::pipeline
