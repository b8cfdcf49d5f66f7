#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "calib/pose_photographs.h"
#include "cli/front/command_table.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/scene.h"
#include "io/board_images.h"
#include "io/image_file.h"
#include "io/photo_lens.h"
#include "io/write_scene.h"
#include "option_flags.h"
#include "pose_colmap.h"
#include "pose_json.h"
#include "pose_masks.h"
#include "scene_arguments.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> images;
  std::string board, out, with, masks;
  PoseOptions pose;
  bool no_masks = false, json = false, ordered = false;
  std::vector<CLI::Option*> of_the_board, of_colmap;  ///< that say nothing to the other way
};

constexpr const char* kColmap = "colmap";

/// Throws UsageError where options are given that belong to the other way.
void check(const Arguments& a) {
  if (a.out.empty()) throw UsageError("--out is empty: give a folder for the scene");
  const bool colmap = a.with == kColmap;
  if (!colmap && a.board.empty())
    throw UsageError(
        "say how the cameras are found: --board FILE for an object on a printed sheet, or --with "
        "colmap for photographs without one");
  for (const CLI::Option* option : colmap ? a.of_the_board : a.of_colmap)
    if (option->count() > 0)
      throw UsageError(concat(option->get_name(), " does not go together with ",
                              colmap ? "--with colmap" : "--board", ": leave one of them out"));
}

/// Names that tell the photographs apart: file names, or paths where two would be alike.
std::vector<std::string> names_of(const std::vector<fs::path>& images) {
  std::multiset<std::string> files;
  for (const fs::path& image : images) files.insert(image.filename().string());
  std::vector<std::string> names;
  for (const fs::path& image : images) {
    const std::string file = image.filename().string();
    names.push_back(files.count(file) == 1 ? file : image.string());
  }
  return names;
}

/// A photograph that cannot be read has no tags, and this reason.
struct ReadPhotos {
  std::vector<PosePhoto> photos;
  std::vector<std::string> unreadable;  ///< of each: why; empty: it was read
};

ReadPhotos find_all_tags(const std::vector<fs::path>& images, const std::vector<std::string>& names,
                         const Sheet& sheet, Progress& progress) {
  ReadPhotos read;
  progress.stage("tags", 0.45);
  for (std::size_t i = 0; i < images.size(); ++i) {
    progress.check_cancelled();
    progress.update(double(i) / double(images.size()));
    PosePhoto photo;
    photo.view.board.name = names[i];
    read.unreadable.emplace_back();
    try {
      const io::PhotoLens lens = io::read_photo_lens(images[i]);
      photo.camera = lens.name, photo.focal = lens.focal;
      photo.view = find_tags(io::read_image(images[i]), sheet, names[i]);
    } catch (const MemoryError&) {
      throw;
    } catch (const Error& failure) {
      read.unreadable.back() = concat("it cannot be read: ", failure.what());
    }
    read.photos.push_back(std::move(photo));
  }
  return read;
}

Scene scene_of(const Arguments& a, const std::vector<fs::path>& images,
               const std::vector<std::string>& names, const PoseResult& result,
               const std::vector<fs::path>& masks) {
  Scene scene;
  scene.path = a.out;
  scene.format = SceneFormat::kTransforms;
  scene.box = result.box;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const PosedPhoto& photo = result.photos[i];
    if (!photo.posed) continue;
    const PosedCamera& camera = result.cameras[std::size_t(photo.camera)];
    scene.views.push_back({names[i],
                           fs::absolute(images[i]).lexically_normal(),
                           masks.empty() ? fs::path() : masks[i],
                           {camera.intrinsics, photo.cam_from_world},
                           camera.distortion});
  }
  return scene;
}

void name_unreadable(const std::vector<std::string>& given) {
  for (const fs::path& file : io::list_unreadable(given))
    std::fprintf(stderr,
                 "warning: %s is left out, for files of its kind cannot be read: convert it to "
                 "JPEG, or set the camera to write JPEG\n",
                 file.c_str());
}

void run_colmap(const Arguments& a, const std::vector<fs::path>& images) {
  const ColmapPoseJob job{images, names_of(images), a.masks, fs::absolute(a.out).lexically_normal(),
                          a.ordered};
  TerminalProgress progress(1);
  const ColmapPose pose = pose_with_colmap(job, progress);
  progress.finish();
  if (a.json)
    std::fputs(pose.report.c_str(), stdout);
  else
    print_colmap_pose(job, pose);
}

void run_board(const Arguments& a, const std::vector<fs::path>& images) {
  const Sheet sheet = read_sheet(a.board);
  const std::vector<std::string> names = names_of(images);
  TerminalProgress progress(1);
  const ReadPhotos read = find_all_tags(images, names, sheet, progress);
  progress.stage("poses", 0.05);
  PoseResult result = pose_photographs(read.photos, sheet, a.pose);
  for (std::size_t i = 0; i < images.size(); ++i)
    if (!read.unreadable[i].empty()) result.photos[i].reason = read.unreadable[i];
  make_folder(a.out, "--out");
  std::vector<fs::path> masks;
  if (!a.no_masks) {
    progress.stage("masks", 0.5);
    std::vector<double> widths;
    for (const PosePhoto& photo : read.photos) widths.push_back(photo.view.edge_width);
    masks = write_sheet_masks(fs::absolute(a.out).lexically_normal() / "masks", images, widths,
                              sheet, result, progress);
  }
  progress.finish();
  const std::string report = pose_json(names, result);
  write_atomically(fs::path(a.out) / "pose.json", report);
  io::write_transforms(scene_of(a, images, names, result, masks), a.out);
  if (a.json)
    std::fputs(report.c_str(), stdout);
  else
    print_pose(names, result);
  if (!a.json) std::printf("  %s\n", a.out.c_str());
}

void run(const Arguments& a) {
  check(a);
  name_unreadable(a.images);
  const std::vector<fs::path> images = io::list_images(a.images);
  if (a.with == kColmap)
    run_colmap(a, images);
  else
    run_board(a, images);
}

}  // namespace

void add_pose(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* c = add_command(app, "pose");
  c->add_option("images", a->images, "photographs of the object, or folders of them")->required();
  a->of_the_board = {c->add_option(
      "--board", a->board, "JSON file that photohull board wrote beside the sheet it printed")};
  c->add_option("--with", a->with, "colmap: without a sheet, by the program COLMAP")
      ->check(CLI::IsMember({kColmap}));
  c->add_option("--out", a->out, "folder for the scene: transforms.json, pose.json and masks/")
      ->required();
  for (CLI::Option* option : add_flags_of(*c, a->pose)) a->of_the_board.push_back(option);
  a->of_the_board.push_back(c->add_flag("--no-masks", a->no_masks,
                                        "make no masks of what differs from the sheet's picture"));
  a->of_colmap = {
      c->add_option("--masks", a->masks,
                    "with COLMAP: folder of masks, NAME.png or NAME.EXT.png; features are looked "
                    "for inside them, and the scene has them"),
      c->add_flag("--ordered", a->ordered,
                  "with COLMAP: each photograph was taken near the one before; only neighbours are "
                  "matched, which is faster")};
  c->add_flag("--json", a->json, "print pose.json instead of a summary");
  c->footer(
      "With --board the world is the sheet's: z = 0 is the paper, z points up, lengths are "
      "millimetres unless --unit says otherwise. With COLMAP its scale and directions are any. "
      "Photographs are in any order; those that get no pose are named with the reason.\n\n"
      "Examples:\n"
      "  photohull board --out board.pdf\n"
      "  photohull pose photos/ --board board.json --out scene --bar 148.5\n"
      "  photohull pose photos/ --with colmap --out scene\n"
      "  photohull reconstruct scene --out model");
  c->callback([a] { run(*a); });
}

}  // namespace photohull::cli
