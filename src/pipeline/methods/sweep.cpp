// Plane sweeps (--method voxel-coloring and space-carving).
#include "carving/photo.h"
#include "core/error.h"
#include "core/option_word.h"
#include "pipeline/methods/method.h"
#include "pipeline/methods/sampler.h"
#include "pipeline/stage_weights.h"
#include "projtex/gpu_views.h"
#include "projtex/sample_images.h"

namespace photohull::pipeline {
namespace {

SparseVolume sweep(projtex::Sampler sampler, const SparseVolume& hull,
                   const carving::PhotoOptions& photo, const SurfaceJob& job,
                   carving::PhotoReport& counts) {
  const std::vector<Camera> cameras = projtex::cameras_of(job.subject.views);
  if (sampler == projtex::Sampler::kMipmap)
    return carving::carve_photo(job.context, hull, {*job.images, cameras}, photo, job.progress,
                                &counts);
  const projtex::SampleImages sampled(job.subject.views, sampler);
  return carving::carve_photo(job.context, hull, {sampled, cameras}, photo, job.progress, &counts);
}

carving::PhotoOptions photo_options(const ReconstructOptions& options, double noise_sigma) {
  Parameters parameters;
  carving::PhotoOptions& photo = parameters.photo;
  photo.method = options.effective_method() == Method::kVoxelColoring
                     ? carving::PhotoMethod::kVoxelColoring
                     : carving::PhotoMethod::kSpaceCarving;
  photo.noise_sigma = noise_sigma;
  photo.supersample = options.supersample.value_or(photo.supersample);
  photo.search_radius = options.r_consistency.value_or(photo.search_radius);
  photo.statistic = options.consistency.value_or(photo.statistic);
  photo.visibility = options.visibility.value_or(photo.visibility);
  tune(options.tune, options.effective_method(), parameters);
  return photo;
}

Surface carve(const SurfaceJob& job, SparseVolume hull) {
  const carving::PhotoOptions photo = photo_options(job.options, job.subject.noise_sigma);
  const projtex::Sampler sampler = sampler_of(job.options);
  carving::PhotoReport counts;
  Surface out;
  out.volume = sweep(sampler, hull, photo, job, counts);
  out.findings.samples = counts.samples;
  SweepFindings& found = out.findings.sweep;
  found.sampling = {projtex::to_string(sampler), photo.supersample,
                    carving::to_string(photo.statistic), visibility::to_string(photo.visibility),
                    photo.search_radius};
  found.sweeps = counts.sweeps;
  found.voxels_judged = counts.judged;
  found.voxels_carved = counts.carved;
  found.voxels_undecided = counts.undecided + counts.reverted;
  if (out.volume.inside_voxels() == 0)
    throw Error(
        concat("photo-consistency carved everything away: the photographs disagree "
               "everywhere; check the cameras (photohull info) or use ",
               option_word("method", "hull")));
  if (counts.judged == 0)
    job.progress.warn("no voxel was seen by enough cameras to be judged: the result is the hull");
  else if (found.voxels_undecided >= counts.judged)
    job.progress.warn(
        "the photographs show too little texture to decide on any voxel: the result is the hull");
  return out;
}

void describe_sweep(Described& to, Parameters& parameters) { describe(to, parameters.photo); }

constexpr MethodEntry entry(Method method, const char* name) {
  return {.method = method,
          .name = name,
          .sweeps = true,
          .by_silhouettes = false,
          .needs_no_silhouettes = false,
          .matches_larger = false,
          .follows = false,
          .in_parts = false,
          .from_hull = true,
          .stage = "photo",
          .weight = Weights::kPhoto,
          .cost = {46e-6, 289e-6, 1200},
          .describe = describe_sweep,
          .carve = carve,
          .sharpen = nullptr,
          .carve_around = nullptr};
}

}  // namespace

projtex::Sampler sampler_of(const ReconstructOptions& options) {
  return options.sampler.value_or(projtex::kDefaultSampler);
}

const MethodEntry kVoxelColoringMethod = entry(Method::kVoxelColoring, "voxel-coloring");
const MethodEntry kSpaceCarvingMethod = entry(Method::kSpaceCarving, "space-carving");

}  // namespace photohull::pipeline
