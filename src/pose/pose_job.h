// Photographs whose cameras are to be found: what all ways of it start from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/pose_photographs.h"
#include "io/photo_lens.h"

namespace photohull::pose {

/// Photographs during which the object did not move.
struct PassOfPhotos {
  std::string name;  ///< of its folder, or its number where folders are called alike
  std::vector<std::filesystem::path> images;
};

struct PoseJob {
  std::vector<std::filesystem::path> images;
  std::vector<std::string> names;  ///< of each image, as names_of gives them
  std::filesystem::path out;       ///< folder for the scene, absolute
  std::filesystem::path board;     ///< description of the printed sheet; empty: by COLMAP
  PoseOptions sheet;               ///< with a sheet
  io::FocalOptions focal;          ///< of photographs whose files state none
  bool make_masks = true;          ///< with a sheet: of what differs from the sheet's picture
  std::filesystem::path masks;     ///< with COLMAP: folder of masks; empty: none
  bool ordered = false;            ///< with COLMAP: each was taken near the one before
  /// With a sheet, in the place of images: the object was laid on another side between passes.
  std::vector<PassOfPhotos> passes;
};

/// Names that tell the photographs apart: file names, or paths where two would be alike.
std::vector<std::string> names_of(const std::vector<std::filesystem::path>& images);

/// A pass for each folder (or file). Throws as io::list_images does.
std::vector<PassOfPhotos> passes_of(const std::vector<std::string>& folders);

/// Makes the folder for the scene, or one within it. Throws Error where that fails.
void make_scene_folder(const std::filesystem::path& folder);

/// A warning where a focal length is given and none of the photographs' lenses takes it; else
/// empty.
std::string unused_focal(const PoseJob& job, bool taken);

}  // namespace photohull::pose
