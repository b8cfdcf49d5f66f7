// Techniques against exact rays, and what they cost.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/describe.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "lab/visibility/study_scenes.h"
#include "visibility/technique.h"

namespace photohull::visibility {

struct StudyOptions {
  std::vector<std::string> scenes = study_scene_names();
  std::vector<int> resolutions{512, 1024, 2048, 4096};
  std::vector<std::string> techniques;  ///< empty: all named ones
  int width = 400, height = 300;        ///< pixels of the receivers' picture
  int silhouettes = 300;                ///< places on silhouettes
  int volume_bricks = 32;               ///< along the side of the volume that is drawn
  int repeats = 2;                      ///< of which the quickest counts
  unsigned seed = 1;

  void validate() const;  ///< throws UsageError naming the option
};

void describe(Described& to, StudyOptions& options);

/// Errors are over the receivers that face the viewpoint.
struct VisibilityErrors {
  double false_occlusion = 0;   ///< visible share that was lost, percent of all receivers
  double false_visibility = 0;  ///< hidden share that was passed as visible, percent
  double total() const { return false_occlusion + false_visibility; }
};

struct StudyCell {
  std::string scene, technique;
  int resolution = 0;
  VisibilityErrors errors;
  double silhouette_texels = 0;  ///< mean distance of silhouettes from the true ones, in texels of
                                 ///< the plain map of this resolution
  double map_ms = 0;   ///< processor time of all threads on software devices, else wall time
  double test_ms = 0;  ///< of all receivers
  std::int64_t bytes = 0;
};

/// A constant bias: no setting is free of both errors.
struct BiasCell {
  std::string scene;
  int resolution = 0;
  double bias_texels = 0;
  VisibilityErrors errors;
};

/// The angle between the viewpoint's direction and the receivers' camera.
struct AngleCell {
  double degrees = 0;
  std::string technique;
  VisibilityErrors errors;
  double silhouette_texels = 0;
  bool warped = false;
};

/// How many of the triangles that can be seen in a texel a map knows, counted by exact clipping.
struct DetectionCell {
  std::string scene, technique;
  int resolution = 0;
  double per_texel = 0;      ///< triangles seen in a texel, mean
  double found_percent = 0;  ///< of all of them
};

/// A volume's map by two ways.
struct VolumeCell {
  std::string way;  ///< "faces" or "march"
  int resolution = 0;
  double map_ms = 0;
  VisibilityErrors errors;
};

/// The receivers' camera's own depth map at 800 x 600.
struct ViewCell {
  std::string scene;
  bool close = false;
  double ms = 0;
  std::int64_t receivers = 0;
};

struct SceneInfo {
  std::string name;
  std::int64_t triangles = 0, vertices = 0, receivers = 0;
  double visible_percent = 0;  ///< of the receivers that face the viewpoint
};

/// What the device cannot hold.
struct LeftOut {
  std::string scene, technique;
  int resolution = 0;
  std::string why;
};

struct Study {
  std::vector<SceneInfo> scenes;
  std::vector<StudyCell> cells;
  std::vector<BiasCell> biases;
  std::vector<AngleCell> angles;
  std::vector<DetectionCell> detection;
  std::vector<VolumeCell> volumes;
  std::vector<ViewCell> views;
  std::vector<LeftOut> left_out;
};

/// Deterministic but for times.
Study study_visibility(gpu::Context& context, const StudyOptions& options, Progress& progress);

/// A crop of the receivers' picture: grey where right, red where visibility was lost, blue where
/// hidden was passed as visible; RGB, row-major, `edge` pixels square, `zoom` times enlarged.
struct StudyPicture {
  int edge = 0;
  std::vector<std::uint8_t> rgb;
};
StudyPicture picture_errors(gpu::Context& context, const StudyScene& scene,
                            const Technique& technique, int edge);

}  // namespace photohull::visibility
