// Arguments that every command about a scene has.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "io/load_scene.h"

namespace photohull::cli {

struct SceneArguments {
  std::string scene, format, box, masks = "auto", views;
  double pixel_center = -1;

  void add_to(CLI::App& command);
  /// Throws UsageError for values that are not understood.
  io::LoadSceneOptions options() const;
};

}  // namespace photohull::cli
