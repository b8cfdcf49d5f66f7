// The stage that makes the photographs' gains alike, on a surface that is known roughly.
#pragma once

#include "core/mesh.h"
#include "core/progress.h"
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
};

struct AlikeViews {
  PhotometricFindings findings;
  bool changed = false;  ///< were pixels divided by gains?
};

/// Gains are measured on coarse hulls of the subject, whose views' pixels change where they differ.
AlikeViews make_alike_on_hull(const PhotometricJob& job, Hull& hull, Subject& subject);

/// The same on a surface with voxels of `voxel_size` world units.
AlikeViews make_alike_on(const PhotometricJob& job, const TriMesh& mesh, double voxel_size,
                         std::vector<PreparedView>& views);

}  // namespace photohull::pipeline
