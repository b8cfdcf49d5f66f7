#include <cstdio>
#include <memory>

#include "calib/turntable_angles.h"
#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "io/write_scene.h"
#include "option_flags.h"
#include "pipeline/convert.h"
#include "scene_arguments.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

struct ConvertArguments {
  SceneArguments scene;
  std::string to, out;
  TurntableAngles angles;
  std::optional<std::string> moment;
  bool undistort = false;
};

io::LoadSceneOptions options_of(const ConvertArguments& a) {
  a.scene.check();
  io::LoadSceneOptions options = a.scene.load;
  if (!a.angles.given() && !a.moment) return options;
  if (options.images.empty())
    throw UsageError("--step, --angles and --moment are for calibrations with --images");
  options.calibrated =
      io::CalibratedImages{options.images, a.angles.step, a.angles.of(0), a.moment.value_or("")};
  options.images.clear();
  return options;
}

void run_convert(const ConvertArguments& a) {
  const SceneFormat format = parse_format("--to", a.to);
  if (a.out.empty()) throw UsageError("--out is empty: give the folder for the converted scene");
  Scene scene = io::load_scene(a.scene.scene, options_of(a));
  std::error_code ignored;
  if (scene.format == format &&
      std::filesystem::equivalent(scene.file.parent_path(), a.out, ignored))
    throw UsageError(concat("--out ", a.out, " holds the ", to_string(format),
                            " scene that is read, which would be lost; give another folder"));
  a.scene.complete_box(scene);
  const std::string from = a.scene.load.images.empty() ? to_string(scene.format) : a.scene.scene;
  for (const std::string& text : scene.warnings)
    std::fprintf(stderr, "photohull: warning: %s\n", text.c_str());
  if (a.undistort) {
    TerminalProgress progress(1);
    progress.stage("undistort", 1);
    scene = pipeline::undistort_scene(scene, a.out, progress);
    progress.finish();
  }
  io::write_scene(scene, format, a.out);
  std::printf("%zu views from %s to %s\n  %s\n", scene.views.size(), from.c_str(),
              to_string(format), a.out.c_str());
}

}  // namespace

void add_convert(CLI::App& app) {
  auto a = std::make_shared<ConvertArguments>();
  CLI::App* c = add_command(app, "convert");
  a->scene.add_to(*c);
  c->add_option("--to", a->to, "format to write: " + format_names())->required();
  c->add_option("--out", a->out, "folder for the result; made when it does not exist")->required();
  c->add_flag("--undistort", a->undistort,
              "resample the photographs and masks to pinhole cameras that any format can express");
  c->get_option("--images")
      ->description(
          "folder of the photographs, where they are not where the scene has them; of a file of "
          "'photohull calibrate' those of the object");
  c->add_option("--moment", a->moment, "rig: which of each camera's photographs, by name");
  add_flags_of(*c, a->angles);
  c->footer(
      "Cameras, box and sparse points are written in the format's own axes and pixel convention; "
      "images stay where they are, unless the format wants them at a place of its own. What a "
      "format cannot express (skew, distortion, a principal point off the centre) is refused, "
      "never dropped: use --undistort.\n\n"
      "Examples:\n"
      "  photohull convert datasets/templeSparseRing --to colmap-text --out out/temple_colmap\n"
      "  photohull convert meshroom/cameras.sfm --to transforms --out out/nerf\n"
      "  photohull convert scan/sparse/0 --to bundler --out out/bundler --undistort\n"
      "  photohull convert rig.json --images pot/ --moment 0001 --to transforms --out out/pot\n"
      "  photohull convert table.json --images pot/ --step 10 --to transforms --out out/pot");
  c->callback([a] { run_convert(*a); });
}

}  // namespace photohull::cli
