// Arguments that every command about a scene has.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "io/load_scene.h"
#include "pipeline/complete_box.h"

namespace photohull::cli {

/// "middlebury, ..., matlab or opencv".
std::string format_names();

/// Throws UsageError naming the option for names that are no format's.
SceneFormat parse_format(const std::string& option, const std::string& text);

/// Adds the argument SCENE.
void add_scene(CLI::App& command, std::string& scene);

/// Throws UsageError where none is given.
void check_scene(const std::string& scene);

/// Throws UsageError where the folder for results is that of the scene's photographs or masks.
void check_output(const std::string& scene, const io::LoadSceneOptions& load,
                  const std::string& out);

/// Makes the folder, and those that it is in, where they are not there; "" is where the program
/// runs. Throws Error, which names the option that asks for it.
void make_folder(const std::filesystem::path& folder, const std::string& option);

struct SceneArguments {
  std::string scene;
  io::LoadSceneOptions load;
  pipeline::BoxOptions box;

  void add_to(CLI::App& command);
  /// Only those that say how the scene's files are read: format, masks, pixel centre,
  /// whether all photographs must be there.
  std::vector<CLI::Option*> add_reading_options(CLI::App& command);
  /// Throws UsageError for values that do not go together.
  void check() const;
  /// Does what the box's options ask for, and nothing where none was given. Throws as
  /// pipeline::complete_box does.
  void complete_box(Scene& loaded) const;
};

}  // namespace photohull::cli
