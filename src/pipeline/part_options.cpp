#include "pipeline/part_options.h"

#include <algorithm>

namespace photohull::pipeline {

ReconstructOptions options_of_whole(ReconstructOptions job, int finer) {
  if (job.resolution) *job.resolution = std::max((*job.resolution + (1 << finer) - 1) >> finer, 2);
  if (job.voxel_size) *job.voxel_size *= 1 << finer;
  return job;
}

ReconstructOptions options_of_part(ReconstructOptions job, const PartNumber& part, int finer,
                                   const std::filesystem::path& whole) {
  job.resolution.reset();
  job.voxel_size.reset();
  job.part = part;
  job.finer = finer;
  job.follow = whole;
  job.validate();
  return job;
}

}  // namespace photohull::pipeline
