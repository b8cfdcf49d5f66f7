#include "scene_arguments.h"

#include "core/error.h"
#include "io/write_scene.h"
#include "option_flags.h"
#include "pipeline/mask_policy.h"

namespace photohull::cli {

std::string format_names() {
  std::string names;
  const std::vector<SceneFormat> formats = io::scene_formats();
  for (const SceneFormat f : formats)
    names += std::string(names.empty() ? "" : f == formats.back() ? " or " : ", ") + to_string(f);
  return names;
}

SceneFormat parse_format(const std::string& option, const std::string& text) {
  for (const SceneFormat f : io::scene_formats())
    if (text == to_string(f)) return f;
  throw UsageError(option + " " + text + ": expected " + format_names());
}

void add_scene(CLI::App& command, std::string& scene) {
  command.add_option("SCENE", scene, "folder or file of the scene")->required();
}

void check_scene(const std::string& scene) {
  if (scene.empty()) throw UsageError("SCENE is empty: give the folder or file of the scene");
}

void check_output(const std::string& scene, const io::LoadSceneOptions& load,
                  const std::string& out) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path given = scene;
  const fs::path folder = fs::is_directory(given, ignored) ? given : given.parent_path();
  for (const fs::path& input :
       {folder / "images", folder / "masks", load.images, load.mask_directory, load.background})
    if (!input.empty() && fs::equivalent(out, input, ignored))
      throw UsageError(concat("--out ", out,
                              " is the folder of the scene's photographs or masks; give a folder "
                              "of its own for the results"));
}

void make_folder(const std::filesystem::path& folder, const std::string& option) {
  std::error_code failure;
  if (!folder.empty()) std::filesystem::create_directories(folder, failure);
  if (failure)
    throw Error(concat(folder.string(), ": the folder cannot be made (", failure.message(),
                       "); choose another with ", option));
}

std::vector<CLI::Option*> SceneArguments::add_reading_options(CLI::App& command) {
  Described described;
  io::describe_reading(described, load);
  return add_flags(command, described);
}

void SceneArguments::add_to(CLI::App& command) {
  add_scene(command, scene);
  Described described;
  describe(described, box, load.box);
  io::describe_views(described, load);
  add_flags(command, described, {"box", "box_scale", "views", "hold_out"});
  add_reading_options(command);
}

void SceneArguments::check() const {
  check_scene(scene);
  load.validate();
  box.validate();
}

void SceneArguments::complete_box(Scene& loaded) const {
  if (!box.find && box.scale == 1) return;
  Progress silent;
  pipeline::complete_box(box, pipeline::mask_policy(load.masks), loaded, silent);
}

}  // namespace photohull::cli
