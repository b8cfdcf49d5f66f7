#include "pipeline/sweep_stage.h"

#include "carving/photo.h"
#include "core/error.h"
#include "pipeline/tuning.h"
#include "projtex/sample_images.h"

namespace photohull::pipeline {
namespace {

SparseVolume sweep(projtex::Sampler sampler, const SparseVolume& hull,
                   const carving::PhotoOptions& photo, const projtex::ImageSet& images,
                   const Inputs& in, gpu::Context& context, Progress& progress,
                   carving::PhotoReport& counts) {
  if (sampler == projtex::Sampler::kMipmap)
    return carving::carve_photo(context, hull, images, in.cameras, photo, progress, &counts);
  const projtex::SampleImages sampled(in.views, sampler);
  return carving::carve_photo(context, hull, sampled, in.cameras, photo, progress, &counts);
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

}  // namespace

projtex::Sampler sampler_of(const ReconstructOptions& options) {
  return options.sampler.value_or(projtex::kDefaultSampler);
}

SparseVolume sweep_hull(const ReconstructOptions& options, const SparseVolume& hull,
                        const projtex::ImageSet& images, Inputs& inputs, gpu::Context& context,
                        Report& report, Progress& progress, std::int64_t& samples) {
  const carving::PhotoOptions photo = photo_options(options, report.noise_sigma);
  const projtex::Sampler sampler = sampler_of(options);
  report.sampling = {projtex::to_string(sampler), photo.supersample,
                     carving::to_string(photo.statistic), visibility::to_string(photo.visibility),
                     photo.search_radius};
  carving::PhotoReport counts;
  SparseVolume volume = sweep(sampler, hull, photo, images, inputs, context, progress, counts);
  report.sweeps = counts.sweeps;
  report.voxels_judged = counts.judged;
  report.voxels_carved = counts.carved;
  report.voxels_undecided = counts.undecided + counts.reverted;
  samples = counts.samples;
  if (volume.inside_voxels() == 0)
    throw Error(
        "photo-consistency carved everything away: the photographs disagree everywhere; "
        "check the cameras (photohull info) or use --method hull");
  if (counts.judged == 0)
    inputs.warn("no voxel was seen by enough cameras to be judged: the result is the hull");
  else if (report.voxels_undecided >= counts.judged)
    inputs.warn(
        "the photographs show too little texture to decide on any voxel: the result is the hull");
  return volume;
}

}  // namespace photohull::pipeline
