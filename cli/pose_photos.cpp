#include "pose_photos.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "io/board_images.h"
#include "option_flags.h"
#include "pose/pose_colmap.h"
#include "pose/pose_passes.h"
#include "pose/pose_sheet.h"
#include "print_passes.h"
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

double weight_of(const PoseJob& job) {
  if (!job.passes.empty()) return pose::passes_weight(job);
  return job.board.empty() ? kColmapWeight : 1;
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
  of_the_board.push_back(command.add_option(
      "--pass", passes,
      "in the place of PHOTOS: two folders or more, one for each side that the object lay on"));
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
  if (!passes.empty()) {
    if (!images.empty() || !video.empty())
      throw UsageError(
          "--pass takes the place of PHOTOS and --video: give all photographs in folders behind "
          "--pass, one for each side that the object lay on");
    if (passes.size() < 2)
      throw UsageError(
          "--pass: give two folders or more, one for each side that the object lay on; photographs "
          "of one side go without --pass");
    std::error_code ignored;
    for (std::size_t i = 0; i < passes.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (fs::equivalent(passes[i], passes[j], ignored))
          throw UsageError(concat("--pass: ", passes[i],
                                  " is given twice: give a folder of its own for each side that "
                                  "the object lay on"));
    return;
  }
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
  TerminalProgress progress(weight_of(job));
  if (!job.passes.empty()) {
    const pose::PassesPose pose = pose::pose_passes(job, progress);
    progress.finish();
    print_warnings(pose.warnings);
    if (tell) print_passes(job, pose);
    return pose.report;
  }
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
