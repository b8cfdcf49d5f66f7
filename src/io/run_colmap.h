// Cameras of photographs without any pose, found by the program COLMAP.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/scene.h"

namespace photohull::io {

struct ColmapPhoto {
  std::filesystem::path image;
  std::filesystem::path mask;  ///< features are looked for inside it; empty: everywhere
  std::string name;            ///< as messages and the scene call it; unique
  std::string lens;            ///< photographs of one lens at one zoom and size have the same here
  double focal = 0;            ///< pixels, to start from; 0: as the file says, or COLMAP supposes
};

struct ColmapJob {
  std::vector<ColmapPhoto> photos;
  std::filesystem::path folder;  ///< what COLMAP writes; anything of an earlier job there goes
  bool ordered = false;          ///< each photograph was taken near the one before, as in a film
};

struct ColmapPhotoFound {
  bool posed = false;
  std::string reason;  ///< one sentence: why it is not
  int features = -1;   ///< that COLMAP found in it; -1: not known
};

struct ColmapFound {
  std::vector<ColmapPhotoFound> photos;  ///< as many as were given
  Scene scene;  ///< those that are posed, in the order given, in COLMAP's world; no box
  std::vector<std::size_t> lens_of_view;  ///< of the scene's views: which have a lens in common
  std::filesystem::path model;            ///< the folder of COLMAP's model
  int models = 0;  ///< that COLMAP made; the one with the most photographs counts
};

/// Features on the processor, all pairs of photographs matched (or neighbours, where they are
/// ordered), and the incremental mapper [Schoenberger16], which leaves principal points in the
/// middle (calib/adjust_lenses.h finds them). What COLMAP says is in colmap.log of the
/// folder. Throws Error where COLMAP is not installed or fails, where it makes no model, where it
/// places fewer than three photographs, and where the folder holds what is not COLMAP's work for
/// this program; Cancelled, and COLMAP ends then.
ColmapFound run_colmap(const ColmapJob& job, Progress& progress);

/// For each image the mask of that folder, by the names that scenes' masks may have; empty where
/// there is none. Throws Error where there is no such folder, or it has no mask for any of them.
std::vector<std::filesystem::path> find_masks(const std::vector<std::filesystem::path>& images,
                                              const std::filesystem::path& folder);

}  // namespace photohull::io
