// What a reconstruction did, as report.json tells it (docs/reference/report.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/grid.h"
#include "pipeline/findings.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/stage_clock.h"

namespace photohull::pipeline {

struct Report {
  std::string version, device;
  NamedValues options;
  std::string option_line;  ///< those that affect the result, in one line
  std::string given_words;  ///< those that were given, as words of a command line
  SceneFindings scene;
  Box box;
  std::string box_source;
  GridSpec grid;
  ViewFindings photographs;
  CameraFindings cameras;
  SilhouetteFindings silhouettes;
  double full_evidence =
      0;  ///< pixels outside an outline at which one view alone carves; 0: at once
  HullFindings hull;
  DeviceFindings device_work;
  PhotometricFindings photometric;
  SurfaceFindings surface;
  std::int64_t voxels_kept = 0, bricks_stored = 0;
  MeshFindings mesh;
  LookFindings look;
  std::optional<TextureFindings> texture;   ///< nothing: none was made
  std::vector<ShellFindings> surroundings;  ///< the innermost first; empty: none were made
  VerdictFindings verdict;
  std::vector<StageTime> stages;
  double wall_seconds = 0, cpu_seconds = 0;
  std::int64_t peak_memory_bytes = 0;
  std::vector<std::string> warnings;
  std::vector<std::string> files;  ///< that were written; empty: none

  std::string to_json() const;
};

}  // namespace photohull::pipeline
