// Masks for the scene that photohull pose writes.
#pragma once

#include <filesystem>
#include <vector>

#include "calib/pose_photographs.h"
#include "core/progress.h"

namespace photohull::cli {

/// The mask of each photograph by what the sheet alone would look like, written to
/// FOLDER/NAME.png; returns the files, an empty path where a photograph is not posed or no mask was
/// found, of which `result` gets a warning.
std::vector<std::filesystem::path> write_sheet_masks(
    const std::filesystem::path& folder, const std::vector<std::filesystem::path>& images,
    const std::vector<double>& edge_widths, const Sheet& sheet, PoseResult& result,
    Progress& progress);

}  // namespace photohull::cli
