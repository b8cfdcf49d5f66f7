// Views that do more harm than good.
#include <algorithm>

#include "assess/wrong_views.h"
#include "cameras/diagnose.h"
#include "core/error.h"
#include "core/left_out.h"
#include "core/option_word.h"
#include "pipeline/silhouette_steps.h"
#include "pipeline/subject.h"
#include "projtex/gpu_views.h"
#include "views/sharpness.h"

namespace photohull::pipeline::silhouettes {
namespace {

// Sharpness beside neighbours below which a view is strongly blurred: 0.80 and more in bunny,
// fandisk, trellis, glazed, plaster, armadillo, tabletop, both rings and fountain; 0.79 to 0.85 in
// views moved by 4 pixels, 0.69 to 0.74 by 8, 0.63 to 0.69 by 16 (folds and arch,
// docs/measurements/stability.md). Without silhouettes views are missed more: leaving out those of
// 8 pixels costs folds 4 points of F at 0.25 %, leaving out those of 16 gains one.
constexpr double kBlurred = 0.75, kBlurredWithoutMasks = 0.69;
constexpr std::size_t kMostNamed = 5;
constexpr double kFarOff = 0.005;  // of the image's longer side: this view is wrong

void drop_view(int index, std::vector<PreparedView>& views, SilhouetteFindings& findings) {
  findings.left_out.push_back(views[std::size_t(index)].name);
  views.erase(views.begin() + index);
}

/// Views whose outlines' tangents are far from all others', who agree; none where these are more
/// than a quarter.
std::vector<int> views_off_tangents(std::span<const PreparedView> views,
                                    std::span<const ViewFit> fits) {
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

/// Views with their outlines, from which some go.
struct Kept {
  std::vector<PreparedView>& views;
  Outlines& outlines;
  SilhouetteFindings& findings;
};

/// The views whose outlines contradict the others', in ascending order; where the camera is known
/// to be right, the mask alone.
void leave_out(std::span<const int> wrong, const std::set<std::string>& right_cameras,
               const std::string& why, const Kept& kept, Progress& progress) {
  for (auto i = wrong.rbegin(); i != wrong.rend(); ++i) {
    PreparedView& view = kept.views[std::size_t(*i)];
    if (right_cameras.contains(view.name)) {
      progress.warn(concat("the mask of ", view.name, " is left out: ", why,
                           "; the view stays, for features say that its camera is right"));
      kept.findings.masks_left_out.push_back(view.name);
      view.mask = {};
      view.silhouette = {};
      kept.outlines[std::size_t(*i)] = {};
      continue;
    }
    progress.warn(concat("view ", view.name, " is left out: ", why));
    drop_view(*i, kept.views, kept.findings);
    kept.outlines.erase(kept.outlines.begin() + *i);
  }
}

std::string names_of(std::span<const int> some, const std::vector<PreparedView>& views) {
  std::string names;
  for (std::size_t i = 0; i < std::min(some.size(), kMostNamed); ++i)
    names += concat(i ? ", " : "", views[std::size_t(some[i])].name);
  return some.size() > kMostNamed ? names + ", ..." : names;
}

}  // namespace

void leave_out_blurred(const SilhouetteJob& job, std::vector<PreparedView>& views,
                       SilhouetteFindings& findings, Progress& progress) {
  const std::vector<double> sharpness =
      relative_sharpness(views, job.box, job.photographs.noise_sigma);
  const double least = any_mask(views) ? kBlurred : kBlurredWithoutMasks;
  std::vector<int> blurred;
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].sharpness = sharpness[i];
    findings.sharpness.emplace_back(views[i].name, sharpness[i]);
    if (sharpness[i] < least) blurred.push_back(int(i));
  }
  if (blurred.empty() || job.options.keep_views) return;
  const std::size_t left = views.size() - blurred.size();
  const bool enough =
      left >= kFewestRemaining && double(left) >= kLeastRemainingShare * double(views.size());
  progress.warn(concat(
      blurred.size(), blurred.size() == 1 ? " view is" : " views are", " blurred beside the others",
      enough ? ", and left out" : "", ": ", names_of(blurred, views),
      enough ? " (" + option_word("keep_views") + " keeps them)"
             : "; too few would remain without them, so they stay: photograph again"));
  if (!enough) return;
  for (auto i = blurred.rbegin(); i != blurred.rend(); ++i) drop_view(*i, views, findings);
}

void leave_out_wrong_views(const SilhouetteJob& job, std::vector<PreparedView>& views,
                           Outlines& outlines, SilhouetteFindings& findings, Progress& progress) {
  const Kept kept{views, outlines, findings};
  const bool keep = job.options.keep_views;
  if (!keep)
    leave_out(
        views_off_tangents(views, fit_silhouettes(projtex::cameras_of(views), outlines)),
        job.right_cameras,
        "its outline is not where the other views' outlines say (check its camera and its mask)",
        kept, progress);
  const assess::SilhouetteConsistency found =
      assess::find_wrong_views(job.box, projtex::cameras_of(views), distances_of(views));
  findings.contradiction = keep ? found.uncovered : found.uncovered_left;
  if (!keep)
    leave_out(found.wrong, job.right_cameras,
              "without it the other views' silhouettes agree (check its camera and its mask)", kept,
              progress);
  findings.common_error = assess::find_common_error(projtex::cameras_of(views), outlines);
}

}  // namespace photohull::pipeline::silhouettes
