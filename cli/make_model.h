// A scene becomes a folder of results, in one piece or in parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "io/load_scene.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/report.h"

namespace photohull::cli {

/// What is in the folder.
struct MadeModel {
  pipeline::VerdictFindings verdict;
  int views = 0;
  double voxel_size = 0;  ///< world units
  std::int64_t triangles = 0;
  std::optional<pipeline::Report> report;  ///< nothing: it was made in parts, and the file tells
};

/// Loads the scene and reconstructs it into the folder. Where its voxels are too many for the
/// memory that it may take, or for one lattice, and the options do not forbid it, it is made in
/// parts: the whole on coarser voxels, then as many parts as memory asks for, in the folder's
/// folder "parts", which goes when they are joined. What is there of them when it is called again
/// is kept. Throws as pipeline::load_photographs, reconstruct_to_folder and join_parts do.
MadeModel make_model(const pipeline::ReconstructOptions& job, const io::LoadSceneOptions& load,
                     const std::filesystem::path& scene, const std::filesystem::path& out,
                     Progress& progress);

}  // namespace photohull::cli
