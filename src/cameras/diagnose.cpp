#include "cameras/diagnose.h"

#include <algorithm>
#include <numbers>

#include "cameras/diagnose_parts.h"
#include "core/error.h"

namespace photohull {
namespace {

constexpr int kFewestMatches = 100;
constexpr int kFewestPairs = 3;

}  // namespace

CameraDiagnosis diagnose_cameras(std::span<const PreparedView> views, const std::optional<Box>& box,
                                 Progress& progress) {
  using namespace diagnosis;
  CameraDiagnosis d;
  Cameras cameras;
  for (const PreparedView& view : views) cameras.push_back(view.camera);
  const std::vector<PairMatches> matches =
      match_without_cameras(views, pairs_to_match(cameras), progress);
  progress.update(0.4);
  d.pairs = int(matches.size());
  for (const PairMatches& m : matches) d.matches += int(std::min(kMostOfPair, m.pixels.size()));
  if (d.matches >= kFewestMatches && d.pairs >= kFewestPairs) {
    d.readings = try_readings(cameras, matches);
    describe_readings(d);
  } else {
    d.notes.push_back(concat("the reading of the poses cannot be checked: only ", d.matches,
                             " feature matches between the photographs"));
  }
  progress.check_cancelled();
  progress.update(0.5);
  if (d.misread) {
    d.notes.push_back("views, pixel centre and box are not judged by misread poses");
    return d;
  }
  const std::vector<FrontierPair> tangents = frontier_pairs(cameras, outlines_of(views));
  d.views.resize(views.size());
  d.usual_residual =
      find_disagreeing(evidence_of(cameras, matches), ViewFit::By::kMatches, d.views);
  find_disagreeing(evidence_of(cameras, tangents), ViewFit::By::kSilhouettes, d.views);
  if (views.size() >= 3) {
    TrackOptions options;
    options.features = 1500;
    const std::vector<Track> tracks = find_tracks(views, options, progress);
    d.pixel_centre = fit_pixel_centre(cameras, d.views, tracks, tangents);
    // A principal point that is off in all views is no single view's fault.
    Cameras centred = cameras;
    for (Camera& camera : centred) {
      camera.intrinsics.cx += d.pixel_centre->shift;
      camera.intrinsics.cy += d.pixel_centre->shift;
    }
    if (find_inconsistent(centred, tracks, d.views))
      d.pixel_centre = fit_pixel_centre(cameras, d.views, tracks, tangents);
  }
  describe_views(views, d);
  if (d.pixel_centre) describe_pixel_centre(d);
  if (box) {
    d.box = fit_box(cameras, matches, *box);
    describe_box(views.size(), d);
  }
  progress.update(1);
  return d;
}

std::vector<ViewFit> fit_silhouettes(std::span<const Camera> cameras,
                                     std::span<const PreparedView> views) {
  return fit_silhouettes(cameras, outlines_of(views));
}

std::vector<ViewFit> fit_silhouettes(std::span<const Camera> cameras,
                                     std::span<const Outline> outlines) {
  using namespace diagnosis;
  PHOTOHULL_CHECK_OP(cameras.size(), ==, outlines.size());
  std::vector<ViewFit> fits(outlines.size());
  find_disagreeing(
      evidence_of(Cameras(cameras.begin(), cameras.end()), frontier_pairs(cameras, outlines)),
      ViewFit::By::kSilhouettes, fits);
  return fits;
}

std::vector<double> outlines_off(std::span<const Camera> cameras,
                                 std::span<const PreparedView> views) {
  return outlines_off(fit_silhouettes(cameras, views));
}

std::vector<double> outlines_off(std::span<const ViewFit> fits) {
  constexpr double kUnusual = 4;  // times what is usual: as where views disagree (find_disagreeing)
  std::vector<double> off;
  std::size_t known = 0, found = 0;
  for (const ViewFit& fit : fits) {
    const bool is_off = fit.residual > std::max(kSuspiciousTangents, kUnusual * fit.others);
    off.push_back(is_off ? std::numbers::sqrt2 * fit.residual : 0);
    known += fit.count > 0, found += is_off;
  }
  if (4 * found > known) std::fill(off.begin(), off.end(), 0.0);
  return off;
}

}  // namespace photohull
