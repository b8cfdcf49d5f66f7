#include <cstdio>
#include <memory>

#include "commands.h"
#include "core/error.h"
#include "io/write_scene.h"
#include "pipeline/convert.h"
#include "scene_arguments.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

struct Arguments {
  SceneArguments scene;
  std::string to, out;
  bool undistort = false;
};

void run(const Arguments& a) {
  const SceneFormat format = parse_format("--to", a.to);
  if (a.out.empty()) throw UsageError("--out is empty: give the folder for the converted scene");
  Scene scene = io::load_scene(a.scene.scene, a.scene.options());
  const std::string from = to_string(scene.format);
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
  auto a = std::make_shared<Arguments>();
  CLI::App* c = app.add_subcommand("convert", "write a scene's cameras for another program");
  a->scene.add_to(*c);
  c->add_option("--to", a->to, "format to write: " + format_names())->required();
  c->add_option("--out", a->out, "folder for the result; made when it does not exist")->required();
  c->add_flag("--undistort", a->undistort,
              "resample the photographs and masks to pinhole cameras that any format can express");
  c->footer(
      "Cameras, box and sparse points are written in the format's own axes and pixel convention; "
      "images stay where they are, unless the format wants them at a place of its own. What a "
      "format cannot express (skew, distortion, a principal point off the centre) is refused, "
      "never dropped: use --undistort.\n\n"
      "Examples:\n"
      "  photohull convert datasets/templeSparseRing --to colmap-text --out out/temple_colmap\n"
      "  photohull convert meshroom/cameras.sfm --to transforms --out out/nerf\n"
      "  photohull convert scan/sparse/0 --to bundler --out out/bundler --undistort");
  c->callback([a] { run(*a); });
}

}  // namespace photohull::cli
