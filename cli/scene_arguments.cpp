#include "scene_arguments.h"

#include <algorithm>
#include <sstream>

#include "core/error.h"
#include "io/write_scene.h"

namespace photohull::cli {
namespace {

Box parse_box(const std::string& text) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream in(spaced);
  double v[6];
  for (double& x : v)
    if (!(in >> x))
      throw UsageError("--box: expected auto or six numbers \"x0 y0 z0 x1 y1 z1\", found '" + text +
                       "'");
  std::string rest;
  if (in >> rest) throw UsageError("--box: '" + rest + "' follows the six numbers");
  const glm::dvec3 a(v[0], v[1], v[2]), b(v[3], v[4], v[5]);
  return {a, b};  // swapped corners are told where the scene is read
}

}  // namespace

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

std::vector<CLI::Option*> SceneArguments::add_reading_options(CLI::App& command) {
  return {
      command.add_option("--format", format, format_names() + " (default: detected)"),
      command
          .add_option(
              "--masks", masks,
              "auto (files, alpha, else a background model), background (always that), none, "
              "or a folder of masks")
          ->capture_default_str(),
      command.add_option("--background", background,
                         "masks from photographs without the object: a file for a camera that "
                         "stands still, or a folder with one for every view"),
      command.add_option("--images", images,
                         "folder of the photographs, where they are not where the scene has them"),
      command.add_option("--pixel-center", pixel_center,
                         "coordinate of the top-left pixel's centre in the scene file, 0, 0.5 or 1 "
                         "(default: the format's)"),
      command.add_flag(
          "--strict", strict,
          "refuse scenes whose photographs are not all there, readable and of their "
          "cameras' shape, and folders of masks that lack some (default: such photographs "
          "are left out while two of three remain, such masks done without)")};
}

void SceneArguments::add_to(CLI::App& command) {
  command.add_option("SCENE", scene, "folder or file of the scene")->required();
  command.add_option("--box", box,
                     "region of interest \"x0 y0 z0 x1 y1 z1\" in world units, or auto: found in "
                     "the photographs (default: the scene's own, else auto)");
  command.add_option("--box-scale", box_scale, "scales the box, whatever it is, about its middle")
      ->capture_default_str();
  command.add_option(
      "--views", views,
      "views to use, e.g. \"0-10,15,img_*.png\"; spread:N (N that show the object from all "
      "sides) or all (default: all; to reconstruct, spread:" +
          std::to_string(io::kEnoughViews) + " where there are more)");
  command.add_option("--hold-out", hold_out,
                     "views to leave out of these, a list of the same kind; 'photohull evaluate "
                     "--photos' judges by them");
  add_reading_options(command);
}

io::LoadSceneOptions SceneArguments::options() const {
  io::LoadSceneOptions out;
  if (scene.empty()) throw UsageError("SCENE is empty: give the folder or file of the scene");
  if (format) out.format = parse_format("--format", *format);
  out.pixel_center = pixel_center;
  if (images && images->empty())
    throw UsageError("--images is empty: give a folder of photographs");
  out.images = images.value_or("");
  out.strict = strict;
  if (box && *box != kFindBox) out.box = parse_box(*box);
  if (views && views->empty()) throw UsageError("--views is empty: write e.g. 0-10,15");
  out.views = views.value_or("");
  if (hold_out && hold_out->empty()) throw UsageError("--hold-out is empty: write e.g. 0,8,16");
  out.hold_out = hold_out.value_or("");
  if (masks == "none") {
    out.masks = io::MaskSource::kNone;
  } else if (masks == "background") {
    out.masks = io::MaskSource::kBackground;
  } else if (masks != "auto") {
    out.masks = io::MaskSource::kDirectory;
    out.mask_directory = masks;
  }
  if (background && background->empty())
    throw UsageError("--background is empty: give a photograph without the object, or a folder");
  out.background = background.value_or("");
  out.validate();
  return out;
}

void SceneArguments::check_output(const std::string& out) const {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path given = scene;
  const fs::path folder = fs::is_directory(given, ignored) ? given : given.parent_path();
  for (const fs::path& input : {folder / "images", folder / "masks", fs::path(images.value_or("")),
                                fs::path(masks), fs::path(background.value_or(""))})
    if (!input.empty() && fs::equivalent(out, input, ignored))
      throw UsageError(concat("--out ", out,
                              " is the folder of the scene's photographs or masks; give a folder "
                              "of its own for the results"));
}

}  // namespace photohull::cli
