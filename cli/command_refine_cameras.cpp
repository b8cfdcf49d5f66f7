#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/write_scene.h"
#include "option_flags.h"
#include "pipeline/mask_policy.h"
#include "pipeline/refine_cameras.h"
#include "scene_arguments.h"
#include "terminal_progress.h"
#include "views/prepare_views.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

struct RefineCamerasArguments {
  SceneArguments scene;
  std::string out;
  std::optional<std::string> to;
  RefineCamerasOptions options;
  bool intrinsics = false, centre_offset = false, poses = false, json = false;
};

void print_summary(const CameraRefinement& r, const Scene& scene) {
  std::printf("%-32s %8s %8s  px, held out\n", "view", "before", "after");
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const ViewAgreement& v = r.views[i];
    if (v.observations > 0)
      std::printf("%-32s %8.3f %8.3f  (%d)\n", scene.views[i].name.c_str(), v.before, v.after,
                  v.observations);
    else
      std::printf("%-32s %8s %8s\n", scene.views[i].name.c_str(), "-", "-");
  }
  std::printf("%-32s %8.3f %8.3f  (%d)\n", "all", r.all.before, r.all.after, r.all.observations);
  std::printf("%-32s %8.3f %8.3f  (%d)\n", "silhouettes' tangents, median", r.tangents_before,
              r.tangents_after, r.tangents);
  if (!r.changed) {
    std::printf("the cameras stay as they were: nothing held out agreed better\n");
    return;
  }
  std::printf("%d tracks (%d given, %d patches of the hull), %d rounds, moved by %.3f px\n",
              r.tracks, r.given_tracks, r.patches, r.rounds, r.moved);
  if (r.focal_factor != 1 || r.principal != glm::dvec2(0))
    std::printf("focal lengths times %.6f, principal points moved by %.3f, %.3f px\n",
                r.focal_factor, r.principal.x, r.principal.y);
}

void run_refine_cameras(const RefineCamerasArguments& a) {
  if (a.out.empty()) throw UsageError("--out is empty: give the folder for the refined scene");
  a.scene.check();
  Scene scene = io::load_scene(a.scene.scene, a.scene.load);
  a.scene.complete_box(scene);
  const SceneFormat format = a.to ? parse_format("--to", *a.to) : scene.format;
  const ViewLoader loader{[](const fs::path& path) { return io::read_image(path); },
                          [](const fs::path& path) { return io::read_mask(path); }};
  PrepareOptions prepare;
  prepare.masks = pipeline::mask_policy(a.scene.load.masks);
  prepare.strict = a.scene.load.strict;
  TerminalProgress progress(4);
  for (const std::string& text : scene.warnings) progress.warn(text);
  progress.stage("views", 1);
  const PreparedViews prepared = prepare_views(scene, loader, prepare, progress);
  for (const std::string& text : prepared.warnings) progress.warn(text);
  progress.stage("refine", 3);
  RefineCamerasOptions options = a.options;
  options.intrinsics = a.intrinsics      ? SharedIntrinsics::kAll
                       : a.centre_offset ? SharedIntrinsics::kPixelCentre
                       : a.poses         ? SharedIntrinsics::kNone
                                         : SharedIntrinsics::kWhereAlike;
  options.given = undistorted_tracks(scene, prepared.views);
  if (options.source == TrackSource::kGiven && options.given.empty())
    throw Error(concat(a.scene.scene, ": lists no tracks of features, which --tracks given needs"));
  options.box = scene.box;
  const CameraRefinement refinement = refine_cameras(prepared.views, options, progress);
  progress.finish();
  pipeline::apply(refinement, scene.views);
  io::write_scene(scene, format, a.out);
  const std::string report = pipeline::to_json(refinement, scene, refinement.changed);
  write_atomically(fs::path(a.out) / "refinement.json", report);
  if (a.json)
    std::fputs(report.c_str(), stdout);
  else
    print_summary(refinement, scene);
}

}  // namespace

void add_refine_cameras(CLI::App& app) {
  auto a = std::make_shared<RefineCamerasArguments>();
  CLI::App* c = add_command(app, "refine-cameras");
  a->scene.add_to(*c);
  c->add_option("--out", a->out, "folder for the refined scene; made when it does not exist")
      ->required();
  c->add_option("--to", a->to, "format to write (default: the scene's own): " + format_names());
  CLI::Option* all = c->add_flag("--intrinsics", a->intrinsics,
                                 "refine focal length and principal point, the same for all views, "
                                 "too (default: where poses would have to err alike without)");
  CLI::Option* centre =
      c->add_flag("--centre-offset", a->centre_offset,
                  "refine poses and an offset of all principal points (another pixel centre)");
  CLI::Option* poses = c->add_flag("--poses", a->poses, "refine poses alone");
  all->excludes(centre, poses);
  centre->excludes(poses);
  add_flags_of(*c, a->options);
  c->add_flag("--json", a->json, "print refinement.json on standard output instead of a summary");
  c->footer(
      "Needs cameras that are right to about ten pixels. Features of the photographs and tangents "
      "of the silhouettes are made to agree; a fifth of both only judges, and nothing is changed "
      "that does not agree better there. Images stay where they are.\n\n"
      "Examples:\n"
      "  photohull refine-cameras datasets/templeSparseRing --out out/temple_refined\n"
      "  photohull refine-cameras scan --intrinsics --to colmap-text --out out/scan_refined");
  c->callback([a] { run_refine_cameras(*a); });
}

}  // namespace photohull::cli
