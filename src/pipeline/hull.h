// Hulls: what silhouettes leave of a box, or frusta where there are none.
#pragma once

#include <memory>
#include <optional>

#include "carving/silhouette_textures.h"
#include "core/grid.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "pipeline/findings.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/subject.h"

namespace photohull::pipeline {

/// Carves hulls of one subject at any resolution, and counts what that took.
class Hull {
 public:
  /// All outlive it.
  Hull(const ReconstructOptions& options, const Subject& subject, gpu::Context& context,
       Progress& progress)
      : options_(options), subject_(subject), context_(context), progress_(progress) {}

  /// Of the subject's box. Throws Error where nothing is left of it.
  SparseVolume carve(const GridSpec& grid);
  /// Of another box; may be empty.
  SparseVolume carve_box(const GridSpec& grid, const Box& box);
  /// Do silhouettes bound what is to be found? Warns where there are some that do not.
  bool bounded();
  /// Share of the hull's surface that goes on beyond the box's sides; 1 without silhouettes.
  double share_beyond();

  /// Frees the device's memory for the silhouettes; a hull that is carved later takes it again.
  void release_textures();

  const HullFindings& findings() const { return findings_; }

 private:
  struct Bounds {
    bool all = false;  ///< carving::silhouettes_bound
    double share_beyond = 0;
  };
  /// By a coarse hull of a slightly larger box.
  const Bounds& bounds();

  const ReconstructOptions& options_;
  const Subject& subject_;
  gpu::Context& context_;
  Progress& progress_;
  HullFindings findings_;
  std::optional<Bounds> bounds_;
  std::unique_ptr<const carving::SilhouetteTextures> textures_;  ///< from the first hull on
};

}  // namespace photohull::pipeline
