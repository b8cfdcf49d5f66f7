// Masks for the scene that photohull pose writes.
#pragma once

#include <filesystem>
#include <vector>

#include "calib/pose_photographs.h"
#include "core/progress.h"
#include "pose/pose_scenery.h"
#include "pose/pose_turntable.h"

namespace photohull::pose {

/// The mask of each photograph by what the sheet alone would look like, written to
/// FOLDER/NAME.png; returns the files, an empty path where a photograph is not posed or no mask was
/// found, of which `result` gets a warning. Photographs of a turntable's stations are compared with
/// what is behind the sheet, too; others with the light on the sheet, if the scenery has it.
std::vector<std::filesystem::path> write_sheet_masks(
    const std::filesystem::path& folder, const std::vector<std::filesystem::path>& images,
    const PhotoEdges& edges, const Sheet& sheet, const TurntableFinding& turntable,
    const SheetScenery& scenery, PoseResult& result, Progress& progress);

}  // namespace photohull::pose
