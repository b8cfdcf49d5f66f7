// The project's own photographs, reconstructed.
#pragma once

#include <cmath>
#include <optional>

#include "pipeline/reconstruct.h"
#include "support/scratch_folder.h"
#include "volume/write_vdb.h"

namespace photohull::pipeline {

struct Reconstruction {
  Report report;
  SparseVolume volume;

  /// Cubic world units.
  double solid() const { return double(report.voxels_kept) * std::pow(report.grid.voxel_size, 3); }
};

inline Reconstruction reconstruct_temple(int resolution, Method method,
                                         std::optional<Box> box = std::nullopt) {
  const ScratchFolder folder;
  ReconstructOptions options;
  options.scene = PHOTOHULL_DATASETS "/templeSparseRing";
  options.output = folder / "out";
  options.resolution = resolution;
  options.method = method;
  options.load.box = box;
  options.device = "software";
  options.refine_cameras = RefineCameras::kOff;  // what the cameras as they are lead to
  Progress silent;
  Reconstruction result;
  result.report = reconstruct(options, silent);
  result.volume = read_vdb_surface(folder / "out/volume.vdb");
  return result;
}

}  // namespace photohull::pipeline
