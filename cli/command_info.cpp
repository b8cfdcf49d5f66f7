#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>

#include "cameras/diagnose.h"
#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "core/left_out.h"
#include "info_output.h"
#include "io/image_file.h"
#include "option_flags.h"
#include "pipeline/box_picture.h"
#include "pipeline/image_scale.h"
#include "pipeline/inspect.h"
#include "pipeline/mask_policy.h"
#include "scene_arguments.h"
#include "terminal_progress.h"
#include "views/prepare_views.h"

namespace photohull::cli {
namespace {

struct InfoArguments {
  SceneArguments scene;
  pipeline::ReconstructOptions job;  ///< those that decide on voxels
  bool json = false, cameras = false, masks = false;
  std::optional<std::string> picture;
};

pipeline::ReconstructOptions job_options(const InfoArguments& a) {
  check_scene(a.scene.scene);
  pipeline::ReconstructOptions o = a.job;
  o.box = a.scene.box;
  o.validate();
  a.scene.load.validate();
  return o;
}

/// Why there is none, or nothing; the rest that is known of the scene is told all the same.
std::string find_box(const InfoArguments& a, Scene& scene, std::vector<ScenePoint>& points) {
  const bool looks = pipeline::looks_for_box(a.scene.box, scene);
  TerminalProgress progress(1);
  if (looks) progress.stage("box", 1);
  try {
    points = pipeline::complete_box(a.scene.box, pipeline::mask_policy(a.scene.load.masks), scene,
                                    progress)
                 .points;
  } catch (const UsageError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& failure) {
    progress.finish();
    return failure.what();
  }
  if (looks) progress.finish();
  return {};
}

/// At which the photographs are read to look into them: as the job would read them, and as they are
/// for the cameras, where half a pixel of the file counts.
std::vector<double> scales_to_look(const InfoArguments& a, const pipeline::ReconstructOptions& job,
                                   const pipeline::Inspection& info) {
  if (!a.cameras && !info.scales.empty()) return info.scales;
  return std::vector<double>(info.scene.views.size(), a.cameras ? 1 : job.image_scale.value_or(1));
}

/// Views that cannot be decoded leave the scene, whose cameras stay those of the files.
PreparedViews prepare(std::span<const double> scales, const SceneArguments& arguments, Scene& scene,
                      Progress& progress) {
  PrepareOptions options;
  options.masks = pipeline::mask_policy(arguments.load.masks);
  options.strict = arguments.load.strict;
  progress.stage("views", 1);
  Scene read = scene;
  pipeline::scale_scene(scales, read);
  PreparedViews prepared = prepare_views(
      read, pipeline::reduced_loader(pipeline::file_reader(), scene, scales), options, progress);
  std::vector<bool> keep;
  std::size_t next = 0;  // of those that were decoded, in the same order
  for (const SourceView& view : scene.views) {
    keep.push_back(next < read.views.size() && read.views[next].name == view.name);
    next += keep.back();
  }
  keep_views(scene, keep);
  scene.left_out = read.left_out;
  scene.usable_share = read.usable_share;
  return prepared;
}

void write_picture(const std::string& path, const pipeline::Inspection& info,
                   std::span<const ScenePoint> points) {
  if (!info.scene.box) throw Error("--picture: there is no box to draw; give --box");
  std::vector<ScenePoint> listed;
  if (points.empty())
    for (const glm::dvec3& p : info.scene.points) listed.push_back({p, {}});
  const RgbImage picture =
      pipeline::draw_box(info.scene, info.scales, info.grid.voxel_size,
                         points.empty() ? std::span<const ScenePoint>(listed) : points);
  make_folder(std::filesystem::path(path).parent_path(), "--picture");
  io::write_png(path, picture.width, picture.height, 3, picture.rgb);
}

void run_info(const InfoArguments& a) {
  if (a.picture && a.picture->empty()) throw UsageError("--picture is empty: give a PNG file");
  const pipeline::ReconstructOptions job = job_options(a);
  io::LoadSceneOptions load = a.scene.load;
  load.most_views = io::kEnoughViews;  // as reconstruct has it
  Scene scene = io::load_scene(a.scene.scene, load);
  std::vector<ScenePoint> points;
  const std::string no_box = find_box(a, scene, points);
  pipeline::Inspection info = pipeline::inspect(scene, job, load.masks);
  std::optional<CameraDiagnosis> diagnosis;
  std::optional<PreparedViews> prepared;
  if (a.cameras || a.masks) {
    TerminalProgress progress(a.cameras ? 4 : 1);
    const std::size_t known = scene.left_out.size();
    prepared = prepare(scales_to_look(a, job, info), a.scene, scene, progress);
    if (scene.left_out.size() > known) {
      // Of what else was found in the photographs --check-masks tells.
      if (!a.masks) scene.warnings.push_back(prepared->warnings.front());
      info = pipeline::inspect(scene, job, load.masks);
    }
    if (a.cameras) {
      progress.stage("cameras", 3);
      diagnosis = diagnose_cameras(prepared->views, scene.box, progress);
    }
    progress.finish();
  }
  if (!no_box.empty()) info.warnings.push_back(no_box);
  if (a.picture && !info.failure) write_picture(*a.picture, info, points);
  const PreparedViews* masks = a.masks ? &*prepared : nullptr;
  (a.json ? print_info_json : print_info_text)(info, masks, diagnosis ? &*diagnosis : nullptr);
  std::fflush(stdout);
  // Said last: what is known of the scene may tell why.
  if (info.failure) std::rethrow_exception(info.failure);
}

}  // namespace

void add_info(CLI::App& app) {
  auto a = std::make_shared<InfoArguments>();
  CLI::App* c = add_command(app, "info");
  a->scene.add_to(*c);
  Described job;
  io::LoadSceneOptions unused;  // those of the scene have flags already
  describe(job, a->job, unused);
  add_flags(*c, job,
            {"resolution", "voxel_size", "quality", "method", "image_scale", "max_memory"});
  c->add_flag("--json", a->json, "print JSON");
  c->add_flag("--cameras", a->cameras,
              "look for faults of the cameras in the photographs, too; takes about half a second "
              "a view");
  c->add_flag("--check-masks", a->masks,
              "find the masks, too, and tell how sure they are ('photohull masks' tells of each)");
  c->add_option("--picture", a->picture,
                "PNG file: the box drawn into photographs, with its corners' coordinates and the "
                "voxels' size, and the cameras from above");
  c->footer(
      "A box that neither the scene nor --box gives is found in the photographs, which takes some "
      "seconds.\n\n"
      "With --cameras, features are matched without the poses and tell how these must be read "
      "(inverse, axes flipped), which views disagree with the rest, whether the principal points "
      "are half a pixel off, and whether the box is where the cameras look. Faults are named and "
      "do not change the exit code.\n\n"
      "Examples:\n"
      "  photohull info datasets/templeSparseRing\n"
      "  photohull info datasets/templeSparseRing --cameras\n"
      "  photohull info scan --resolution 512 --masks none\n"
      "  photohull info datasets/templeSparseRing --box auto --picture box.png\n"
      "  photohull info colmap/sparse/0 --box \"-1 -1 0 1 1 2\" --json");
  c->callback([a] { run_info(*a); });
}

}  // namespace photohull::cli
