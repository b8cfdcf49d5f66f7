// The main job: photographs in, volume and mesh out.
#pragma once

#include <functional>
#include <optional>

#include "core/grid.h"
#include "core/mesh.h"
#include "core/mesh_texture.h"
#include "core/progress.h"
#include "io/mesh/write_mesh.h"
#include "page/make_page.h"
#include "pipeline/missing_picture.h"
#include "pipeline/photographs.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/report.h"
#include "render/preview.h"
#include "volume/attributes.h"

namespace photohull::pipeline {

/// What confidence was computed from, and where the model does not fit
/// (ReconstructOptions::evidence).
struct Evidence {
  TriMesh mesh;              ///< uniform, with the surface that no camera sees
  VertexScalars scalars;     ///< of its vertices
  MissingPicture missing;    ///< where the model leaves the masks empty; empty without masks
  MissingPicture explained;  ///< what of a photograph the model explains; empty with masks
};

/// Takes the volume when it is done, which then need not be held while the rest is made.
using TakeVolume = std::function<void(SparseVolume, VolumeAttributes)>;

/// All of it in memory, in world units. Volume and attributes are empty where they were taken.
struct Reconstruction {
  SparseVolume volume;          ///< truncated signed distances, voxels, negative inside
  VolumeAttributes attributes;  ///< colours and confidence near its surface
  TriMesh mesh;                 ///< with colours, normals and confidence
  /// For files that hold a texture: where such a format is among the options' exports.
  std::optional<TexturedMesh> textured;
  glm::dvec3 up{0, 0, 1};  ///< the world axis that is upward in most photographs
  RgbImage preview;
  std::optional<Evidence> evidence;  ///< on demand
  std::optional<page::Shown> shown;  ///< what report.html shows, unless it is off
  Report report;                     ///< of all but writing files
};

/// Reconstructs scenes with the same options, one after another.
class Reconstructor {
 public:
  /// Throws UsageError naming the option that is wrong.
  explicit Reconstructor(ReconstructOptions options);

  /// Reports stages, warnings and progress to `progress`, and throws Cancelled at the next safe
  /// point after its token was cancelled. Throws Error where nothing can be reconstructed;
  /// MemoryError. A result that fails its own checks is none: report.verdict tells. With the option
  /// `checkpoint`, levels that are done are kept in that folder.
  Reconstruction run(const Photographs& photographs, Progress& progress,
                     const TakeVolume& take_volume = {}) const;

  const ReconstructOptions& options() const { return options_; }

 private:
  ReconstructOptions options_;
};

}  // namespace photohull::pipeline
