// What pose and scan do alike: photographs or a film, and the way in which cameras are found.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "io/film_frames.h"
#include "pose/pose_job.h"

namespace photohull::cli {

using pose::names_of;
using pose::passes_of;
using pose::PassOfPhotos;
using pose::PoseJob;

/// Arguments that both commands have.
struct PoseArguments {
  std::vector<std::string> images;  ///< files, or folders of them
  std::vector<std::string> passes;  ///< a folder each, in the place of images; empty: one pass
  std::string video;                ///< a film in the place of images; empty: none
  io::FrameOptions frames;
  std::string board;
  PoseOptions sheet;
  io::FocalOptions focal;
  bool ordered = false;
  std::vector<CLI::Option*> of_film, of_the_board, of_colmap;  ///< that say nothing otherwise

  /// `but`: options of the sheet that the command has none of.
  void add_to(CLI::App& command, const std::vector<std::string>& but = {});
  /// Files and folders of all photographs.
  const std::vector<std::string>& given() const { return passes.empty() ? images : passes; }
  /// Throws UsageError unless there is one of photographs, passes of them, and film, and for
  /// options of the other.
  void check() const;
};

/// Throws UsageError where one of the options was given; `instead` is what it does not go with.
void refuse_given(const std::vector<CLI::Option*>& options, const std::string& instead);

/// Prints a warning for each photograph in the folders given that cannot be read.
void name_unreadable(const std::vector<std::string>& given);

/// Finds the cameras and writes the scene into the job's folder (pose/pose_sheet.h,
/// pose/pose_passes.h, pose/pose_colmap.h). Prints warnings, and a summary if `tell`. Returns
/// pose.json.
std::string pose_photos(const PoseJob& job, bool tell);

}  // namespace photohull::cli
