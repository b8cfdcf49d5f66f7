#include "pose_photos.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "io/board_images.h"
#include "option_flags.h"
#include "pose/pose_colmap.h"
#include "pose/pose_sheet.h"
#include "print_pose.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

// io::run_colmap's stages, a look at the photographs, and the lenses.
constexpr double kColmapWeight = 1.2;

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& text : warnings) std::fprintf(stderr, "warning: %s\n", text.c_str());
}

}  // namespace

void PoseArguments::add_to(CLI::App& command, const std::vector<std::string>& but) {
  command.add_option("PHOTOS", images, "photographs of the object, or folders of them");
  command.add_option("--video", video,
                     "film in the place of photographs, from which sharp pictures are taken");
  of_film = add_flags_of(command, frames);
  add_flags_of(command, focal);
  of_the_board = {command.add_option(
      "--board", board, "JSON file that photohull board wrote beside the sheet it printed")};
  Described described;
  describe(described, sheet);
  std::vector<std::string> described_names;
  for (const Option& option : described.options())
    if (std::ranges::find(but, option.name) == but.end()) described_names.push_back(option.name);
  for (CLI::Option* option : add_flags(command, described, described_names))
    of_the_board.push_back(option);
  of_colmap = {command.add_flag(
      "--ordered", ordered,
      "with COLMAP: each photograph was taken near the one before; only neighbours "
      "are matched, which is faster")};
}

void PoseArguments::check() const {
  if (images.empty() && video.empty())
    throw UsageError("PHOTOS is missing: give photographs, folders of them, or --video FILE");
  if (!images.empty() && !video.empty())
    throw UsageError("photographs and --video exclude each other: give one");
  if (!video.empty()) return;
  for (const CLI::Option* option : of_film)
    if (option->count() > 0)
      throw UsageError(concat(option->get_name(), " is for films: give one with --video"));
}

void refuse_given(const std::vector<CLI::Option*>& options, const std::string& instead) {
  for (const CLI::Option* option : options)
    if (option->count() > 0)
      throw UsageError(concat(option->get_name(), " does not go together with ", instead,
                              ": leave one of them out"));
}

void name_unreadable(const std::vector<std::string>& given) {
  for (const fs::path& file : io::list_unreadable(given))
    std::fprintf(stderr,
                 "warning: %s is left out, for files of its kind cannot be read: convert it to "
                 "JPEG, or set the camera to write JPEG\n",
                 file.c_str());
}

std::string pose_photos(const PoseJob& job, bool tell) {
  TerminalProgress progress(job.board.empty() ? kColmapWeight : 1);
  if (job.board.empty()) {
    const pose::ColmapPose pose = pose::pose_with_colmap(job, progress);
    progress.finish();
    print_warnings(pose.warnings);
    if (tell) print_colmap_pose(job, pose);
    return pose.report;
  }
  const pose::SheetPose pose = pose::pose_on_sheet(job, progress);
  progress.finish();
  print_warnings(pose.result.warnings);
  if (tell) {
    print_pose(job.names, pose.result, pose.turntable);
    std::printf("  %s\n", job.out.c_str());
  }
  return pose.report;
}

}  // namespace photohull::cli
