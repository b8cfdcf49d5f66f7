// Inputs: cameras that the photographs correct.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cameras/diagnose.h"
#include "cameras/feature_tracks.h"
#include "cameras/refine_cameras.h"
#include "carving/missing_parts.h"
#include "carving/object_box.h"
#include "core/error.h"
#include "masks/mask_bias.h"
#include "masks/mask_lines.h"
#include "pipeline/inputs.h"
#include "pipeline/refine_cameras.h"
#include "projtex/gpu_views.h"

namespace photohull::pipeline {
namespace {

constexpr int kFewestFeatures = 20;  // held-out ones that confirm a camera
constexpr double kAgrees = 0.5;      // pixels, of these
constexpr double kMended = 0.5;      // of what the outlines of views were off

std::string in_common(const CameraRefinement& found) {
  return concat(" (in all views focal lengths times ", std::round(1e4 * found.focal_factor) / 1e4,
                ", principal points by ", hundredths(found.principal.x), ", ",
                hundredths(found.principal.y), " px)");
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

/// Refines the cameras of the views that are off; all others agree and stay as they are.
void Inputs::refine_cameras_of(const std::vector<double>& off) {
  RefineCamerasOptions o;
  for (std::size_t i = 0; i < off.size(); ++i)
    if (off[i] == 0) o.held.push_back(int(i));
  o.given = undistorted_tracks(scene, views);
  o.box = scene.box;
  const CameraRefinement found = photohull::refine_cameras(views, o, progress_);
  const double left = sum(outlines_off(found.cameras, views));
  const bool use = found.changed && left < kMended * sum(off);
  report_.camera_refinement = to_json(found, scene, use);
  if (!use) return;
  const std::size_t count = off.size() - o.held.size();
  warn(concat(
      "the outlines of ", count, count == 1 ? " view" : " views",
      " are off what the others say, by up to ",
      hundredths(*std::max_element(off.begin(), off.end())),
      " px: the cameras of these were refined (--refine-cameras off takes them as they are)"));
  use_cameras(found);
}

void Inputs::use_cameras(const CameraRefinement& found) {
  apply(found, scene);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].camera = found.cameras[i];
}

void Inputs::refine_cameras() {
  const bool asked = options_.refine_cameras.has_value();
  if (!asked) {
    report_.mask_disagreement = tangent_disagreement(views);
    if (!(report_.mask_disagreement > kSuspiciousTangents)) {
      const std::vector<double> off = outlines_off(projtex::cameras_of(views), views);
      if (sum(off) > 0) refine_cameras_of(off);
      return;
    }
  }
  RefineCamerasOptions o;
  if (options_.refine_cameras == RefineCameras::kPosesAndIntrinsics)
    o.intrinsics = SharedIntrinsics::kAll;
  else if (options_.refine_cameras != RefineCameras::kPoses)
    o.intrinsics = SharedIntrinsics::kWhereAlike;
  o.given = undistorted_tracks(scene, views);
  o.box = scene.box;
  const CameraRefinement found = photohull::refine_cameras(views, o, progress_);
  const bool always = asked && options_.refine_cameras != RefineCameras::kAuto;
  // Outlines alone say nothing of cameras where the masks' maker took the tips of thin parts.
  const bool trusted =
      asked || found.all.observations > 0 || (!masks_are_eaten() && fill_no_less(found.cameras));
  const bool use = found.changed && (always || (pays(found) && trusted));
  report_.camera_refinement = to_json(found, scene, use);
  remember_right_cameras(found, use);
  if (!use) return;
  if (!asked)
    warn(concat("the masks' outlines disagree by ", hundredths(report_.mask_disagreement),
                " px: the cameras were refined",
                shares_intrinsics(found) ? in_common(found) : std::string(),
                ", and what they see agrees to ",
                hundredths(found.all.observations ? found.all.after : found.tangents_after),
                " px instead of ",
                hundredths(found.all.observations ? found.all.before : found.tangents_before),
                " (--refine-cameras off takes them as they are)"));
  cameras_moved = found.moved;
  cameras_moved_alike = found.moved_alike;
  use_cameras(found);
}

bool Inputs::masks_are_eaten() const {
  std::vector<SilhouetteDistance> distances(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!views[i].mask.empty()) distances[i] = silhouette_distance(views[i].mask);
  });
  const MaskBias bias = measure_mask_bias(views, distances);
  return bias.counts() && bias.pixels > 0;
}

/// Tips below the masks' sampling end too early, each view's elsewhere: outlines that are made to
/// agree at them leave the rest contradicting each other.
bool Inputs::fill_no_less(std::span<const Camera> refined) const {
  const Box box = carving::box_is_oversized(*scene.box, views)
                      ? carving::object_box(*scene.box, views)
                      : *scene.box;
  std::vector<Mask> masks(views.size());
  std::vector<std::vector<LinePoint>> found(views.size());
  std::vector<SilhouetteDistance> distances(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    masks[i] = views[i].mask;
    found[i] = find_lines(masks[i]);
    photohull::widen_lines(found[i], masks[i]);
    distances[i] = silhouette_distance(masks[i]);
  });
  std::vector<carving::Silhouette> all;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (masks[i].empty())
      all.push_back({&masks[i]});
    else
      all.push_back({&masks[i], &distances[i], &found[i], made_masks_.contains(views[i].name)});
  const auto unexplained = [&](std::span<const Camera> with) {
    int count = 0;
    for (const carving::ForegroundCounts& v :
         carving::find_missing_parts(box, with, all, {}, &progress_).views)
      count += v.unexplained;
    return count;
  };
  return unexplained(refined) <= unexplained(projtex::cameras_of(views));
}

/// Features of a view whose camera is right lie where those of other views say, whatever its mask.
void Inputs::remember_right_cameras(const CameraRefinement& found, bool used) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewAgreement& v = found.views[i];
    if (v.observations >= kFewestFeatures && (used ? v.after : v.before) <= kAgrees)
      right_cameras_.insert(views[i].name);
  }
}

}  // namespace photohull::pipeline
