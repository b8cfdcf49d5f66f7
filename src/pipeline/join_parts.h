// The results of parts made one result.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "pipeline/findings.h"

namespace photohull::pipeline {

struct JoinedParts {
  VerdictFindings verdict;  ///< of the whole
  int views = 0;
  double voxel_size = 0;  ///< world units
  bool joined = false;    ///< the volumes, too? Else the report names the parts that have them
  std::int64_t triangles = 0;
  std::size_t seam_vertices = 0, open_edges = 0;  ///< as Stitched has them
};

/// Writes volume.vdb, mesh.ply, preview.png (that of the whole) and report.json into `folder`, of
/// the results of a whole and of all of its parts. One mesh of a part is in memory at a time. Where
/// the volumes do not fit into `max_memory` bytes together (nothing: default_max_memory()), there
/// is no volume.vdb, with a warning; the report's "parts" are the list of them. Warns where an edge
/// stays open at a seam. Throws Error where a folder holds no such result; Cancelled.
JoinedParts join_parts(const std::filesystem::path& whole,
                       const std::vector<std::filesystem::path>& parts,
                       const std::filesystem::path& folder,
                       const std::optional<std::int64_t>& max_memory, Progress& progress);

}  // namespace photohull::pipeline
