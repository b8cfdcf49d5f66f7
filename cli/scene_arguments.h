// Arguments that every command about a scene has.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/load_scene.h"
#include "pipeline/complete_box.h"

namespace photohull::cli {

/// "middlebury, ..., matlab or opencv".
std::string format_names();

/// Throws UsageError naming the option for names that are no format's.
SceneFormat parse_format(const std::string& option, const std::string& text);

struct SceneArguments {
  static constexpr const char* kFindBox = "auto";  ///< --box

  std::string scene, masks = "auto";
  std::optional<std::string> format, box, views, hold_out;
  std::optional<std::string> background, images;
  std::optional<double> pixel_center;
  bool strict = false;
  double box_scale = 1;

  void add_to(CLI::App& command);
  /// Only those that say how the scene's files are read: format, masks, pixel centre,
  /// whether all photographs must be there.
  std::vector<CLI::Option*> add_reading_options(CLI::App& command);
  /// Throws UsageError for values that are not understood.
  io::LoadSceneOptions options() const;
  /// Throws UsageError where the folder for results is that of the scene's photographs or masks.
  void check_output(const std::string& out) const;
  /// The same of --box auto and --box-scale.
  pipeline::BoxOptions box_options() const;
  /// Does what these two ask for, and nothing where neither was given. Throws as
  /// pipeline::complete_box does.
  void complete_box(Scene& loaded) const;
};

}  // namespace photohull::cli
