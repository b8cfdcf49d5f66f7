// What a reconstruction did, as report.json tells it (docs/reference/report.md).
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assess/verdict.h"
#include "core/box.h"
#include "core/grid.h"
#include "core/scene.h"
#include "pipeline/input_hashes.h"

namespace photohull::pipeline {

struct StageReport {
  std::string name;
  double wall_seconds = 0;
  double cpu_seconds = 0;              ///< user + system, all threads
  std::int64_t samples = 0;            ///< texture samples, where the stage takes any
  std::int64_t peak_memory_bytes = 0;  ///< of the process up to the stage's end
};

/// One level of the refinement, coarsest first.
struct RefineLevelReport {
  double voxel_size = 0;  ///< world units
  double wall_seconds = 0;
  std::int64_t surfels = 0;   ///< surface points matched in its last iteration
  std::int64_t samples = 0;   ///< texture samples
  std::int64_t bricks = 0;    ///< of 8^3 voxels, stored at its end
  std::int64_t restored = 0;  ///< voxels of the hull that silhouettes brought back
  std::int64_t freed = 0;     ///< voxels before surface that views see through them
  /// Bricks of its surface that the next level matches, and those that it does not match again.
  std::int64_t split = 0, settled_pixels = 0, settled_plain = 0, settled_flat = 0;
  double mean_move = 0;  ///< voxels, in its last iteration
  double evidence = 0;   ///< share of its surfels that the photographs say a place for
};

/// One pass of the photometric refinement.
struct RefineFitReport {
  double wall_seconds = 0;
  double held_out = 0, held_out_fitted = 0;  ///< mean scores of the views that were held out
  double mean_move = 0;                      ///< voxels
  bool kept = false;
};

/// Distances between mesh.ply and the uniform mesh, both ways, in voxels.
struct MeshErrorReport {
  double limit = 0;  ///< as asked for
  double mean = 0, p95 = 0, p999 = 0, max = 0;
};

/// A coarser grid around the box (pipeline/surroundings.h).
struct ShellReport {
  Box box;
  double voxel_size = 0;  ///< world units
  glm::ivec3 voxels{0};
  std::int64_t triangles = 0;  ///< before simplification
  double area_share = 0;       ///< of the whole mesh's area, [0, 1]
};

/// How the plane sweep looked at the photographs.
struct SamplingReport {
  std::string sampler;
  int supersample = 0;
  std::string consistency;
  std::string visibility;
  double r_consistency = 0;  ///< pixels
};

/// What silhouettes show of thin parts, and where they disagree (masks/mask_lines.h,
/// carving/missing_parts.h, carving/fit_stems.h).
struct ThinReport {
  std::int64_t line_pixels = 0;      ///< of all masks: parts narrower than about two pixels
  std::int64_t looked_at = 0;        ///< places of the foreground
  std::int64_t unexplained = 0;      ///< of these, without a point that all silhouettes bear
  std::int64_t placed = 0;           ///< of the unexplained, given the place that most views bear
  std::int64_t restored_pixels = 0;  ///< of lines that eaten masks had lost, in all views
  std::int64_t stem_vertices = 0;    ///< of the mesh, put to where lines say
  std::string worst_view;            ///< with the largest share left unexplained; empty: none
};

/// A view whose outline is off what the other views' say.
struct OutlineRoom {
  std::string view;
  double pixels = 0;  ///< by which its outline was widened
};

/// Where a view's mask came from, and how sure it is (calib's MaskJudgement).
struct MaskReport {
  std::string view, source;
  double confidence = 0;
};

struct Report {
  std::string version;
  std::string scene, format, device;
  std::vector<InputFile> inputs;
  std::vector<std::pair<std::string, std::string>> options;
  int views = 0;
  int photographs_listed = 0;                     ///< by the scene's file
  int photographs_scaled = 0;                     ///< as Scene::scaled
  int photographs_passed_over = 0;                ///< as Scene::passed_over
  std::vector<LeftOutView> photographs_left_out;  ///< for they cannot be used
  Box box;
  std::string box_source;
  double smallest_scale = 1, largest_scale = 1;  ///< at which photographs were read
  std::string mask_source;
  double mask_confidence = 0;
  /// Pixels (cameras/refine_cameras.h, tangent_disagreement); NaN where it was not looked at.
  double mask_disagreement = NAN;
  /// Pixels outside an outline at which one view alone carves (HullOptions); 0: at once.
  double full_evidence = 0;
  int masks_mended = 0;                   ///< by masks/torn_masks.h
  std::vector<OutlineRoom> outline_room;  ///< of views whose outlines are off
  double mask_offset = 0;         ///< pixels by which the masks' outlines were moved outward
  std::vector<MaskReport> masks;  ///< of each view
  ThinReport thin;
  std::string missing_view;       ///< that missing.png shows; empty: there is none
  std::string explained_view;     ///< that explained.png shows; empty: there is none
  std::string camera_refinement;  ///< JSON (pipeline/refine_cameras.h); empty: not asked for
  std::string photometric;        ///< JSON (pipeline/photometric.h); empty: not asked for
  std::string photometric_line;   ///< the same, for the screen
  assess::Verdict verdict;
  std::string verdict_json;           ///< the same with what it rests on (pipeline/self_check.h)
  std::vector<std::string> left_out;  ///< views whose silhouettes contradict the others'
  std::vector<std::pair<std::string, double>> sharpness;  ///< of each view (views/sharpness.h)
  std::vector<std::string> masks_left_out;                ///< of views whose cameras are right
  double noise_sigma = 0;  ///< square-root-encoded units of full scale
  GridSpec grid;
  std::vector<StageReport> stages;
  std::int64_t nodes_tested = 0, bricks_evaluated = 0;
  std::int64_t voxels_judged = 0, voxels_carved = 0, voxels_kept = 0, voxels_undecided = 0;
  std::int64_t bricks_stored = 0;
  int sweeps = 0;
  std::optional<SamplingReport> sampling;
  int resumed_levels = 0;  ///< of refine_levels, done by an earlier run that was interrupted
  std::vector<RefineLevelReport> refine_levels;
  std::vector<RefineFitReport> refine_fits;
  std::int64_t vertices = 0, triangles = 0;
  std::int64_t uniform_triangles = 0;   ///< before simplification
  std::int64_t sharpened_vertices = 0;  ///< moved onto sharp edges, or onto what meets there
  std::optional<MeshErrorReport> mesh_error;
  std::vector<ShellReport> surroundings;  ///< the innermost first; empty: none were made
  std::int64_t islands = 0;       ///< pieces of the open mesh that too few photographs support
  double islands_area_share = 0;  ///< of the open mesh's area, that went with them
  double unseen_share = 0;        ///< of the mesh's vertices
  std::int64_t peak_memory_bytes = 0;
  double wall_seconds = 0, cpu_seconds = 0;
  std::vector<std::string> warnings;
  std::vector<std::string> files;

  std::string to_json() const;
};

/// User + system seconds of the process so far, all threads.
double process_cpu_seconds();
/// Largest resident set of the process so far.
std::int64_t process_peak_memory();

}  // namespace photohull::pipeline
