#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "film_pictures.h"
#include "io/board_images.h"
#include "pose_photos.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

struct PoseCommand {
  PoseArguments photos;
  std::string out, with, masks;
  bool no_masks = false, json = false;
};

constexpr const char* kColmap = "colmap";

/// Throws UsageError where options are given that belong to the other way.
void check(const PoseCommand& a) {
  a.photos.check();
  if (a.out.empty()) throw UsageError("--out is empty: give a folder for the scene");
  const bool colmap = a.with == kColmap;
  if (!colmap && a.photos.board.empty())
    throw UsageError(
        "say how the cameras are found: --board FILE for an object on a printed sheet, or --with "
        "colmap for photographs without one");
  if (colmap)
    refuse_given(a.photos.of_the_board, "--with colmap");
  else
    refuse_given(a.photos.of_colmap, "--board");
  if (a.no_masks && !a.photos.passes.empty())
    throw UsageError(
        "--no-masks does not go together with --pass: passes are joined by what masks say is the "
        "object");
}

void run_pose(const PoseCommand& a) {
  check(a);
  PoseJob job;
  job.out = fs::absolute(a.out).lexically_normal();
  if (!a.photos.passes.empty()) {
    name_unreadable(a.photos.passes);
    job.passes = passes_of(a.photos.passes);
  } else if (a.photos.video.empty()) {
    name_unreadable(a.photos.images);
    job.images = io::list_images(a.photos.images);
  } else {
    job.images = take_pictures(a.photos.video, job.out / "frames", a.photos.frames);
  }
  job.names = names_of(job.images);
  job.board = a.photos.board;
  job.sheet = a.photos.sheet;
  job.focal = a.photos.focal;
  job.make_masks = !a.no_masks;
  job.masks = a.masks;
  job.ordered = a.photos.ordered;
  const std::string report = pose_photos(job, !a.json);
  if (a.json) std::fputs(report.c_str(), stdout);
}

}  // namespace

void add_pose(CLI::App& app) {
  auto a = std::make_shared<PoseCommand>();
  CLI::App* c = add_command(app, "pose");
  a->photos.add_to(*c);
  c->add_option("--with", a->with, "colmap: without a sheet, by the program COLMAP")
      ->check(CLI::IsMember({kColmap}));
  c->add_option("--out", a->out,
                "folder for the scene: transforms.json, pose.json, coverage.png and masks/")
      ->required();
  a->photos.of_the_board.push_back(c->add_flag(
      "--no-masks", a->no_masks, "make no masks of what differs from the sheet's picture"));
  a->photos.of_colmap.push_back(
      c->add_option("--masks", a->masks,
                    "with COLMAP: folder of masks, NAME.png or NAME.EXT.png; features are looked "
                    "for inside them, and the scene has them"));
  c->add_flag("--json", a->json, "print pose.json instead of a summary");
  c->footer(
      "With --board the world is the sheet's: z = 0 is the paper, z points up, lengths are "
      "millimetres unless --unit says otherwise. With COLMAP its scale and directions are any. "
      "Photographs are in any order; those that get no pose are named with the reason. With --pass "
      "the object was laid on another side between folders: each is posed by the sheet, and the "
      "object's texture then tells how they lie to each other.\n\n"
      "Examples:\n"
      "  photohull board --out board.pdf\n"
      "  photohull pose photos/ --board board.json --out scene --bar 148.5\n"
      "  photohull pose --pass side1/ side2/ --board board.json --out scene\n"
      "  photohull pose photos/ --with colmap --out scene\n"
      "  photohull pose --video film.mp4 --with colmap --out scene\n"
      "  photohull reconstruct scene --out model");
  c->callback([a] { run_pose(*a); });
}

}  // namespace photohull::cli
