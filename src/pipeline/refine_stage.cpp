#include "pipeline/refine_stage.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "pipeline/checks.h"
#include "pipeline/job_identity.h"
#include "pipeline/tuning.h"

namespace photohull::pipeline {
namespace {

// High quality: iterations of matching at the finest voxels, passes of fitting patches to the
// photographs after them, and Gauss-Newton steps of each.
constexpr int kHighIterations = 2, kHighPasses = 3, kHighSteps = 3;
// Masks that were made from the background are wrong in places, and mostly at their rims: a part
// comes back only when one view in so many asks for it, so many pixels within its mask.
constexpr int kDoubtingViews = 3;
constexpr double kDoubtfulRim = 2;
constexpr double kLeastEvidence = 0.1;  // share of the surface below which a result is doubtful

}  // namespace

RefineStage::RefineStage(const ReconstructOptions& options, Inputs& inputs, gpu::Context& context,
                         Report& report, Progress& progress)
    : options_(options), in_(inputs), context_(context), report_(report), progress_(progress) {
  Parameters parameters;
  refine::RefineOptions& refine = parameters.refine;
  refine.noise_sigma = report.noise_sigma;
  if (options.quality == Quality::kHigh) {
    refine.fine_iterations = kHighIterations;
    refine.photometric = kHighPasses;
    refine.fit.steps = kHighSteps;
  }
  if (report.mask_confidence < 1) {
    refine.restore.least_views =
        std::max(refine.restore.least_views, int(inputs.cameras.size()) / kDoubtingViews);
    refine.restore.least_inside = kDoubtfulRim;
  }
  tune(options.tune, Method::kRefine, parameters);
  refine_ = refine;
  sharpen_ = parameters.sharpen;
}

SparseVolume RefineStage::run(HullStage& hull, const projtex::ImageSet& images, bool bounded) {
  refine_.bounded = bounded;
  const refine::CheckpointFile checkpoint{
      checkpoint_path(), job_identity(options_, in_.scene, in_.grid, report_.device)};
  if (options_.fresh) remove_checkpoint();
  refine::RefineReport counts;
  SparseVolume volume =
      refine::refine_surface(context_,
                             {in_.grid, [&](const GridSpec& grid) { return hull.carve(grid); },
                              in_.silhouettes_of_views(), images, in_.cameras},
                             refine_, progress_, &counts, &checkpoint);
  note(counts);
  if (volume.inside_voxels() == 0 && !in_.any_mask())
    throw Error(concat(
        "no surface was found: without masks the photographs must show texture that several of "
        "them agree on; give masks (--masks), more views, or check the cameras (photohull info)",
        told_of_cameras_within(*in_.scene.box, in_.scene.box_source, in_.scene.views)));
  if (volume.inside_voxels() == 0)
    throw Error(
        "refinement left nothing: the photographs disagree everywhere; check the cameras "
        "(photohull info) or use --method hull");
  const double evidence = counts.levels.back().evidence;
  if (evidence < kLeastEvidence)
    in_.warn(concat("the photographs tell where the surface is on ", std::lround(100 * evidence),
                    " % of it only (too little texture, or too few cameras that see the same): the "
                    "rest is the hull's guess"));
  return volume;
}

SparseVolume RefineStage::run_around(HullStage& hull, const projtex::ImageSet& images,
                                     const GridSpec& grid, const Box& box, double nearest_angle) {
  refine::RefineOptions options = refine_;
  options.bounded = false;
  options.match.nearest_angle = options.vote.nearest_partner = nearest_angle;
  refine::RefineReport counts;
  SparseVolume volume = refine::refine_surface(
      context_,
      {grid, [&](const GridSpec& coarse) { return hull.carve_box(coarse, box); },
       in_.silhouettes_of_views(), images, in_.cameras},
      options, progress_, &counts);
  for (const refine::LevelReport& level : counts.levels) samples_ += level.samples;
  return volume;
}

void RefineStage::note(const refine::RefineReport& counts) {
  report_.resumed_levels = counts.resumed;
  for (const refine::FitReport& fit : counts.fits)
    report_.refine_fits.push_back(
        {fit.seconds, fit.held_before, fit.held_after, fit.mean_move, fit.kept});
  for (const refine::LevelReport& level : counts.levels) {
    report_.refine_levels.push_back({level.voxel_size, level.seconds, level.surfels, level.samples,
                                     level.bricks, level.restored, level.freed, level.split,
                                     level.settled_pixels, level.settled_plain, level.settled_flat,
                                     level.mean_move, level.evidence});
    samples_ += level.samples;
  }
}

std::filesystem::path RefineStage::checkpoint_path() const {
  return options_.output / ".photohull-checkpoint";
}

void RefineStage::remove_checkpoint() const {
  std::error_code ignored;  // what cannot be removed belongs to another job, or to this one anew
  std::filesystem::remove(checkpoint_path(), ignored);
}

}  // namespace photohull::pipeline
