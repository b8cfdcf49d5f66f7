// The stage that measures the photographs' gains, on a surface that is known roughly.
#pragma once

#include <optional>
#include <vector>

#include "core/mesh.h"
#include "core/progress.h"
#include "pipeline/earlier_results.h"
#include "pipeline/findings.h"
#include "pipeline/hull.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/subject.h"

namespace photohull::pipeline {

/// What it goes by.
struct PhotometricJob {
  const ReconstructOptions& options;
  double noise_sigma = 0;  ///< of the photographs
  Progress& progress;
  const ResultRig* rig = nullptr;  ///< whose gains hold; null: none
};

/// Do gains hold that were measured before? Then nothing is measured.
bool gains_are_known(const PhotometricJob& job);

/// Gains are measured on coarse hulls of the subject.
MeasuredGains measure_gains_on_hull(const PhotometricJob& job, Hull& hull, const Subject& subject);

/// The same on a surface with voxels of `voxel_size` world units.
MeasuredGains measure_gains_on(const PhotometricJob& job, const TriMesh& mesh, double voxel_size,
                               const std::vector<PreparedView>& views);

}  // namespace photohull::pipeline
