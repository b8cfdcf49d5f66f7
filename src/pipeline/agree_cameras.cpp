#include "pipeline/agree_cameras.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cameras/diagnose.h"
#include "cameras/feature_tracks.h"
#include "cameras/look_at_cameras.h"
#include "cameras/refine_cameras.h"
#include "carving/missing_parts.h"
#include "carving/object_box.h"
#include "core/error.h"
#include "core/option_word.h"
#include "masks/mask_bias.h"
#include "masks/mask_lines.h"
#include "masks/silhouette.h"
#include "pipeline/rounded_pixels.h"
#include "pipeline/subject.h"
#include "projtex/gpu_views.h"

namespace photohull::pipeline {
namespace {

constexpr int kFewestFeatures = 20;  // held-out ones that confirm a camera
constexpr double kAgrees = 0.5;      // pixels, of these
constexpr double kMended = 0.5;      // of what the outlines of views were off
constexpr double kWorthTelling = 4;  // times what is suspicious, where no cameras fit better

std::string in_common(const CameraRefinement& found) {
  return concat(" (in all views focal lengths times ", std::round(1e4 * found.focal_factor) / 1e4,
                ", principal points by ", hundredths(found.principal.x), ", ",
                hundredths(found.principal.y), " px)");
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

std::string how_to_refuse() {
  return concat(" (", option_word("refine_cameras", "off"), " takes them as they are)");
}

RefineCamerasOptions refine_options(const Scene& scene, std::span<const PreparedView> views) {
  RefineCamerasOptions o;
  o.given = undistorted_tracks(scene, views);
  o.box = scene.box;
  return o;
}

void use_cameras(const CameraRefinement& found, std::vector<PreparedView>& views) {
  std::vector<SourceView> sources = sources_of(views);
  pipeline::apply(found, sources);
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].source = std::move(sources[i]);
    views[i].camera = found.cameras[i];
  }
}

/// Refines the cameras of the views that are off; all others agree and stay as they are.
void refine_those_off(const std::vector<double>& off, const Scene& scene, AgreeingCameras& out,
                      Progress& progress) {
  RefineCamerasOptions o = refine_options(scene, out.views);
  for (std::size_t i = 0; i < off.size(); ++i)
    if (off[i] == 0) o.held.push_back(int(i));
  const CameraRefinement found = photohull::refine_cameras(out.views, o, progress);
  const double left = sum(outlines_off(found.cameras, out.views));
  const bool use = found.changed && left < kMended * sum(off);
  out.findings.refinement = to_json(found, scene, use);
  if (!use) return;
  const std::size_t count = off.size() - o.held.size();
  progress.warn(concat("the outlines of ", count, count == 1 ? " view" : " views",
                       " are off what the others say, by up to ",
                       hundredths(*std::max_element(off.begin(), off.end())),
                       " px: the cameras of these were refined", how_to_refuse()));
  use_cameras(found, out.views);
}

bool masks_are_eaten(std::span<const PreparedView> views) {
  std::vector<SilhouetteDistance> distances(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!views[i].mask.empty()) distances[i] = silhouette_distance(views[i].mask);
  });
  std::vector<const SilhouetteDistance*> given;
  for (const SilhouetteDistance& d : distances) given.push_back(d.pixels.empty() ? nullptr : &d);
  const MaskBias bias = measure_mask_bias(views, given);
  return bias.counts() && bias.pixels > 0;
}

/// Do the silhouettes leave no more of their foreground unexplained with these cameras? Tips below
/// the masks' sampling end too early, each view's elsewhere: outlines that are made to agree at
/// them leave the rest contradicting each other.
bool fill_no_less(std::span<const Camera> refined, const Box& given,
                  const std::vector<PreparedView>& views, Progress& progress) {
  const Box box =
      carving::box_is_oversized(given, views) ? carving::object_box(given, views) : given;
  std::vector<Mask> masks(views.size());
  std::vector<std::vector<LinePoint>> found(views.size());
  std::vector<SilhouetteDistance> distances(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    masks[i] = views[i].mask;
    found[i] = find_lines(masks[i]);
    widen_lines(found[i], masks[i]);
    distances[i] = silhouette_distance(masks[i]);
  });
  std::vector<carving::Silhouette> all;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (masks[i].empty())
      all.push_back({&masks[i]});
    else
      all.push_back({&masks[i], &distances[i], &found[i], views[i].silhouette.likelihood});
  const auto unexplained = [&](std::span<const Camera> with) {
    int count = 0;
    for (const carving::ForegroundCounts& v :
         carving::find_missing_parts(box, with, all, {}, &progress).views)
      count += v.unexplained;
    return count;
  };
  return unexplained(refined) <= unexplained(projtex::cameras_of(views));
}

/// Features of a view whose camera is right lie where those of other views say, whatever its mask.
std::set<std::string> confirmed_by_features(const CameraRefinement& found, bool used,
                                            std::span<const PreparedView> views) {
  std::set<std::string> right;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewAgreement& v = found.views[i];
    if (v.observations >= kFewestFeatures && (used ? v.after : v.before) <= kAgrees)
      right.insert(views[i].name);
  }
  return right;
}

SharedIntrinsics intrinsics_of(const std::optional<RefineCameras>& refine) {
  if (refine == RefineCameras::kPosesAndIntrinsics) return SharedIntrinsics::kAll;
  return refine == RefineCameras::kPoses ? RefineCamerasOptions().intrinsics
                                         : SharedIntrinsics::kWhereAlike;
}

void warn_of_wrong_cameras(const CameraRefinement& found, bool used, const CameraFindings& findings,
                           Progress& progress) {
  const bool by_features = std::isfinite(findings.features.pixels);
  const std::string off =
      by_features ? concat("the cameras have the photographs' features ",
                           hundredths(findings.features.pixels), " px from where they are")
                  : concat("the masks' outlines disagree by ",
                           hundredths(findings.mask_disagreement), " px");
  if (used)
    progress.warn(
        concat(off, ": the cameras were refined",
               shares_intrinsics(found) ? in_common(found) : std::string(),
               ", and what they see agrees to ",
               hundredths(found.all.observations ? found.all.after : found.tangents_after),
               " px instead of ",
               hundredths(found.all.observations ? found.all.before : found.tangents_before),
               how_to_refuse()));
  else if (findings.features.pixels > kWorthTelling * findings.features.suspicious)
    progress.warn(concat(off, ", and none were found that fit clearly better: check them (",
                         command_word("info", "cameras"), ")"));
}

void refine_all(const ReconstructOptions& options, const Scene& scene, AgreeingCameras& out,
                Progress& progress) {
  const std::optional<RefineCameras>& asked = options.refine_cameras;
  RefineCamerasOptions o = refine_options(scene, out.views);
  o.intrinsics = intrinsics_of(asked);
  const CameraRefinement found = photohull::refine_cameras(out.views, o, progress);
  const bool always = asked && *asked != RefineCameras::kAuto;
  // Outlines alone say nothing of cameras where the masks' maker took the tips of thin parts.
  const bool trusted =
      asked || found.all.observations > 0 ||
      (!masks_are_eaten(out.views) && fill_no_less(found.cameras, *scene.box, out.views, progress));
  const bool use = found.changed && (always || (pays(found) && trusted));
  out.findings.refinement = to_json(found, scene, use);
  out.right = confirmed_by_features(found, use, out.views);
  if (!asked) warn_of_wrong_cameras(found, use, out.findings, progress);
  if (!use) return;
  out.findings.moved = found.moved;
  out.findings.moved_alike = found.moved_alike;
  use_cameras(found, out.views);
}

/// A quick look, by outlines where there are such, else by features.
bool look_wrong(AgreeingCameras& out, Progress& progress) {
  constexpr std::size_t kFewestViews = 3;  // that can be refined
  out.findings.mask_disagreement = tangent_disagreement(out.views);
  if (std::isfinite(out.findings.mask_disagreement))
    return out.findings.mask_disagreement > kSuspiciousTangents;
  if (out.views.size() < kFewestViews) return false;
  out.findings.features = look_at_features(out.views, progress);
  return out.findings.features.pixels > out.findings.features.suspicious;
}

}  // namespace

AgreeingCameras agree_cameras(const ReconstructOptions& options, const Scene& scene,
                              std::vector<PreparedView> views, Progress& progress) {
  AgreeingCameras out{std::move(views), {}, {}};
  if (!options.refine_cameras && !look_wrong(out, progress)) {
    const std::vector<double> off = outlines_off(projtex::cameras_of(out.views), out.views);
    if (sum(off) > 0) refine_those_off(off, scene, out, progress);
    return out;
  }
  refine_all(options, scene, out, progress);
  return out;
}

}  // namespace photohull::pipeline
