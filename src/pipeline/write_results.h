// Results into a folder, all together or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "pipeline/reconstruct.h"

namespace photohull::pipeline {

/// Writes volume.vdb, mesh.ply, preview.png and report.json; report.html where the result has what
/// that shows; the mesh in further formats (io/mesh/mesh_writers.h); and with evidence also
/// evidence.ply and missing.png or explained.png.
/// The folder is made where it does not exist. Returns the report with what writing took and the
/// names of the files. Throws Error when that fails; earlier results then stay as they were (but
/// see ResultFiles::commit), and no half-written file is left.
Report write(const Reconstruction& result, const std::filesystem::path& folder, Progress& progress,
             const std::vector<std::string>& formats = {}, const MeshFileOptions& mesh_files = {});

/// Reconstructs into a folder, which is made and tried before the work, and which keeps the levels
/// of a refinement that are done until the job has ended well. Throws as Reconstructor::run and
/// write do.
Report reconstruct_to_folder(const ReconstructOptions& options, const Photographs& photographs,
                             const std::filesystem::path& folder, Progress& progress);

}  // namespace photohull::pipeline
