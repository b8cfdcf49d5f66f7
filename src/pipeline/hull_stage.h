// The stage that carves hulls: what silhouettes leave of a box, or frusta where there are none.
#pragma once

#include <cstdint>
#include <optional>

#include "carving/hull.h"
#include "core/grid.h"
#include "gpu/context.h"
#include "pipeline/inputs.h"

namespace photohull::pipeline {

class HullStage {
 public:
  /// All outlive it.
  HullStage(const ReconstructOptions& options, Inputs& inputs, gpu::Context& context,
            Report& report)
      : options_(options), in_(inputs), context_(context), report_(report) {}

  /// Of the scene's box. Throws Error where nothing is left of it.
  SparseVolume carve(const GridSpec& grid);
  /// Of another box; may be empty.
  SparseVolume carve_box(const GridSpec& grid, const Box& box);
  /// Of the scene's box at its own grid, with a warning where no masks shape it.
  SparseVolume carve_alone();
  /// Do silhouettes bound what is to be found? Warns where there are some that do not.
  bool bounded();
  /// Share of the hull's surface that goes on beyond the box's sides; 1 without silhouettes.
  double share_beyond();
  /// Gains measured on the hull, if the photographs' differ.
  void correct_photometric(Progress& progress);

  std::int64_t samples() const { return samples_; }

 private:
  struct Bounds {
    bool all = false;  ///< carving::silhouettes_bound
    double share_beyond = 0;
  };
  /// By a coarse hull of a slightly larger box.
  const Bounds& bounds();

  const ReconstructOptions& options_;
  Inputs& in_;
  gpu::Context& context_;
  Report& report_;
  std::int64_t samples_ = 0;
  std::optional<Bounds> bounds_;
};

/// A quick look before gains are solved for; tells the report where they do not differ.
bool photographs_are_alike(const TriMesh& mesh, double voxel_size, Inputs& inputs, Report& report,
                           Progress& progress);

/// Whether the views' pixels changed; tells the report.
bool correct_photometric(Photometric mode, const TriMesh& mesh, double voxel_size, Inputs& inputs,
                         Report& report, Progress& progress);

}  // namespace photohull::pipeline
