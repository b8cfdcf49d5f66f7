// A folder of results, read back for pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/mesh_texture.h"
#include "pipeline/findings.h"

namespace photohull::pipeline {

struct ResultModel {
  TriMesh mesh;                          ///< of mesh.ply; empty where there is a texture
  std::optional<TexturedMesh> textured;  ///< of mesh.glb, where that has a texture
  LookFindings look;                     ///< as report.json tells

  const TriMesh& shape() const { return textured ? textured->mesh : mesh; }
};

/// What report.json of a folder of results tells. Throws as read_result does.
struct ResultReport {
  LookFindings look;
  std::string photometric;  ///< JSON (pipeline/photometric.h); empty: it was not asked for
  bool followed = false;    ///< RefineFindings::followed
};
ResultReport read_report(const std::filesystem::path& folder);

/// What it tells of a whole that parts are made of. Throws as read_result does.
struct WholeReport {
  Box box;                         ///< that was reconstructed
  VerdictFindings verdict;         ///< and as JSON
  std::vector<double> hull_trust;  ///< RefineFindings::hull_trust; empty: it tells none
};
WholeReport read_whole_report(const std::filesystem::path& folder);

/// Names of the files that a folder's report.json lists; none where there is no report, or it is
/// damaged.
std::vector<std::string> listed_files(const std::filesystem::path& folder);

/// The model of a folder that `write` wrote: from mesh.glb where the report says that it has a
/// texture, else from mesh.ply. Normals are there. Throws Error where there is no such folder,
/// where one of its files is missing or damaged, and where the report is of a version that told no
/// cameras.
ResultModel read_result(const std::filesystem::path& folder);

/// The camera of a photograph, by its name or its index from 0 in the report. Throws Error that
/// names the option `camera` and the nearest name where there is none.
const CameraPose& find_camera(const LookFindings& look, const std::string& view);

}  // namespace photohull::pipeline
