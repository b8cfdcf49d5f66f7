// The surface moved to where its patches agree between views (--method refine).
#include "refine/refine.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "core/option_word.h"
#include "mesh/sharpen_edges.h"
#include "pipeline/checkpoint_folder.h"
#include "pipeline/checks.h"
#include "pipeline/job_identity.h"
#include "pipeline/larger_photographs.h"
#include "pipeline/methods/method.h"
#include "pipeline/stage_weights.h"
#include "projtex/gpu_views.h"
#include "refine/shared_work.h"

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
constexpr double kDetail = 1.5;         // pixels: what refinement resolves, by its patches

Parameters parameters_of(const SurfaceJob& job) {
  Parameters parameters;
  refine::RefineOptions& refine = parameters.refine;
  refine.noise_sigma = job.subject.noise_sigma;
  if (job.options.quality == Quality::kHigh) {
    refine.fine_iterations = kHighIterations;
    refine.fit_passes = kHighPasses;
    refine.fit.steps = kHighSteps;
  }
  if (job.subject.mask_confidence < 1) {
    refine.restore.least_views =
        std::max(refine.restore.least_views, int(job.subject.views.size()) / kDoubtingViews);
    refine.restore.least_inside = kDoubtfulRim;
  }
  tune(job.options.tune, Method::kRefine, parameters);
  refine.bounded = job.bounded;
  return parameters;
}

SurfaceFindings findings_of(const refine::RefineReport& counts) {
  SurfaceFindings out;
  out.refine.resumed_levels = counts.resumed;
  out.refine.followed = counts.followed;
  out.refine.hull_trust = counts.hull_trust();
  for (const refine::FitReport& fit : counts.fits)
    out.refine.fits.push_back(
        {fit.seconds, fit.held_before, fit.held_after, fit.mean_move, fit.kept});
  for (const refine::LevelReport& level : counts.levels) {
    out.refine.levels.push_back({level.voxel_size, level.seconds, level.surfels, level.samples,
                                 level.bricks, level.restored, level.freed, level.split,
                                 level.settled_pixels, level.settled_plain, level.settled_flat,
                                 level.mean_move, level.evidence});
    out.samples += level.samples;
  }
  return out;
}

/// Throws Error where nothing was found, and warns where little was.
void check_found(const SurfaceJob& job, const SparseVolume& volume,
                 const refine::RefineReport& counts) {
  const Subject& subject = job.subject;
  if (volume.inside_voxels() == 0 && !any_mask(subject.views))
    throw Error(concat(
        "no surface was found: without masks the photographs must show texture that several of "
        "them agree on; give masks (",
        option_word("masks"), "), more views, or check the cameras (photohull info)",
        sentence_about_cameras(subject.box, subject.box_source, sources_of(subject.views))));
  if (volume.inside_voxels() == 0)
    throw Error(
        concat("refinement left nothing: the photographs disagree everywhere; check the "
               "cameras (photohull info) or use ",
               option_word("method", "hull")));
  const double evidence = counts.levels.back().evidence;
  if (evidence < kLeastEvidence)
    job.progress.warn(
        concat("the photographs tell where the surface is on ", std::lround(100 * evidence),
               " % of it only (too little texture, or too few cameras that see the same): the "
               "rest is the hull's guess"));
}

/// Levels that an interrupted run of the same job has done are taken from its checkpoint.
std::optional<refine::CheckpointFile> checkpoint_of(const SurfaceJob& job) {
  if (job.options.checkpoint.empty()) return std::nullopt;
  const std::filesystem::path file = checkpoint_file(job.options.checkpoint);
  if (job.options.fresh) remove_checkpoint(job.options.checkpoint);
  return refine::CheckpointFile{
      file, job_identity(job.options, job.photographs, job.subject, job.context.device().renderer)};
}

/// What other processes help with; null: nothing. Only jobs that can go on from where they were are
/// shared, for helpers know a job as its checkpoint does.
std::unique_ptr<refine::SharedWork> shared_work_of(
    const SurfaceJob& job, const projtex::Photographs& photographs,
    const std::optional<refine::CheckpointFile>& checkpoint) {
  const SharedTiles& tiles = job.options.tiles;
  if (tiles.count < 2 || !checkpoint) return nullptr;
  auto out = std::make_unique<refine::SharedWork>(tiles.folder, checkpoint->job, tiles.count,
                                                  job.progress);
  out->publish(photographs, job.larger);
  return out;
}

Surface carve(const SurfaceJob& job, SparseVolume) {
  const std::optional<refine::CheckpointFile> checkpoint = checkpoint_of(job);
  refine::RefineReport counts;
  Surface out;
  const std::vector<Camera> cameras = projtex::cameras_of(job.subject.views);
  const std::vector<carving::Silhouette> silhouettes = silhouettes_of(job.subject.views);
  // No hull is finer, and none is carved later as a rule: its textures go.
  const auto hull_at = [&](const GridSpec& grid) {
    // Of the whole something is there, and a part may be empty.
    SparseVolume hull = job.part ? job.hull.carve_box(grid, job.subject.box) : job.hull.carve(grid);
    if (grid.voxel_size == job.subject.grid.voxel_size) job.hull.release_textures();
    return hull;
  };
  const refine::RefineOptions options = parameters_of(job).refine;
  std::optional<refine::WholeSurface> whole;
  if (job.part)
    whole.emplace(refine::WholeSurface{job.part->near, job.part->first_voxel, job.options.finer,
                                       job.beside, job.part->hull_trust});
  const auto shared = shared_work_of(job, {*job.images, cameras, options.noise_sigma}, checkpoint);
  out.volume =
      refine::refine_surface(job.context,
                             {job.subject.grid, hull_at, silhouettes, *job.images, cameras,
                              job.larger, job.before, shared.get(), whole ? &*whole : nullptr},
                             options, job.progress, &counts, checkpoint ? &*checkpoint : nullptr);
  out.findings = findings_of(counts);
  if (job.before && !counts.followed)
    job.progress.note(concat(job.options.follow.string(),
                             job.bounded
                                 ? ": too much lies elsewhere now, so the surface was found anew"
                                 : ": without masks the surface is found anew"));
  if (!job.part) check_found(job, out.volume, counts);
  return out;
}

SparseVolume carve_around(const SurfaceJob& job, const AroundBox& around, std::int64_t& samples) {
  refine::RefineOptions options = parameters_of(job).refine;
  options.bounded = false;
  options.match.nearest_angle = options.vote.nearest_partner = around.nearest_angle;
  refine::RefineReport counts;
  const std::vector<Camera> cameras = projtex::cameras_of(job.subject.views);
  const std::vector<carving::Silhouette> silhouettes = silhouettes_of(job.subject.views);
  SparseVolume volume = refine::refine_surface(
      job.context,
      {around.grid, [&](const GridSpec& coarse) { return job.hull.carve_box(coarse, around.box); },
       silhouettes, *job.images, cameras},
      options, job.progress, &counts);
  samples += findings_of(counts).samples;
  return volume;
}

std::int64_t sharpen(const SurfaceJob& job, TriMesh& mesh) {
  const Subject& subject = job.subject;
  const double voxel = subject.grid.voxel_size;
  const double detail =
      kDetail * carving::pixel_footprint(subject.box, matched_cameras(subject.views));
  return std::int64_t(
      sharpen_edges(parameters_of(job).sharpen, voxel, std::max(detail, voxel), mesh));
}

void describe_refine(Described& to, Parameters& parameters) {
  describe(to, parameters.refine);
  to.group("sharpen", parameters.sharpen);
}

}  // namespace

const MethodEntry kRefineMethod = {.method = Method::kRefine,
                                   .name = "refine",
                                   .sweeps = false,
                                   .by_silhouettes = false,
                                   .needs_no_silhouettes = true,
                                   .matches_larger = true,
                                   .follows = true,
                                   .in_parts = true,
                                   .from_hull = false,
                                   .stage = "refine",
                                   .weight = Weights::kRefine,
                                   .cost = {34e-6, 42e-6, 329, 1.4e-6},
                                   .describe = describe_refine,
                                   .carve = carve,
                                   .sharpen = sharpen,
                                   .carve_around = carve_around};

}  // namespace photohull::pipeline
