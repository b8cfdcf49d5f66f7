// The scene's box: given, or found in its photographs.
#pragma once

#include <optional>
#include <vector>

#include "cameras/scene_points.h"
#include "core/describe.h"
#include "core/progress.h"
#include "core/scene.h"
#include "pipeline/photographs.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {

struct BoxOptions {
  static constexpr double kLeastScale = 0.05, kMostScale = 20;
  bool find = false;  ///< even where the scene or the user gives one
  double scale = 1;
  bool exact = false;

  /// Throws UsageError naming the option.
  void validate() const;
};

/// `given`: the box that the user gives (io::LoadSceneOptions).
void describe(Described& to, BoxOptions& options, std::optional<Box>& given);

struct BoxFindings {
  bool found = false;              ///< by the photographs, not given
  std::vector<ScenePoint> points;  ///< that it was found by, if any
  std::optional<Box> seen;         ///< around what the photographs show beside that, where known
};

/// Will complete_box look into the photographs?
bool looks_for_box(const BoxOptions& options, const Scene& scene);

/// Gives the scene a box: its own, else the one that find_box finds in at most 60 of its
/// photographs, spread over all and reduced to 800 pixels at most, with their masks by `masks`. A
/// box that load_scene made of sparse points stands only where none is found, which adds a warning
/// to the scene. Then scales it. Throws Error as find_box and prepare_views do; Cancelled.
BoxFindings complete_box(const BoxOptions& options, MaskPolicy masks, Scene& scene,
                         Progress& progress, const PhotographReader& reader = file_reader());

}  // namespace photohull::pipeline
