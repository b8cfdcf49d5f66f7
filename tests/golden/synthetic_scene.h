// Scenes of datasets/synthetic, made small, reconstructed, and judged against their exact surface.
#pragma once

#include <optional>
#include <string>

#include "eval/evaluate.h"
#include "pipeline/reconstruct.h"
#include "support/scratch_folder.h"
#include "synth/spec.h"

namespace photohull::golden {

/// A scene in a folder of its own that goes away with it.
class SyntheticScene {
 public:
  /// Renders datasets/synthetic/NAME.json with `views` views of width x height pixels.
  SyntheticScene(const std::string& name, int views, int width, int height);
  /// Renders any spec.
  explicit SyntheticScene(const synth::Spec& spec);

  /// Reconstructs with `resolution` voxels along the box's longest side, in software, and judges
  /// the mesh over the surface that cameras see. `sampler`: of the sweeps, if not the default.
  eval::Evaluation reconstruct(pipeline::Method method, int resolution,
                               std::optional<projtex::Sampler> sampler = {}) const;

 private:
  ScratchFolder folder_;
  eval::Truth truth_;
};

/// F-score of the seen surface in percent, at a threshold in percent of the truth's diagonal that
/// evaluate() measures.
double f_score(const eval::Evaluation& evaluation, double threshold_percent);

/// One line of every figure that the golden tests bound.
std::string summary(const eval::Evaluation& evaluation);

}  // namespace photohull::golden
