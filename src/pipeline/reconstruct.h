// The main job: photographs in, volume and mesh out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carving/statistic.h"
#include "core/progress.h"
#include "io/load_scene.h"
#include "pipeline/complete_box.h"
#include "pipeline/photometric.h"
#include "pipeline/refine_cameras.h"
#include "pipeline/report.h"
#include "projtex/sampler.h"
#include "visibility/sweep_test.h"

namespace photohull::pipeline {

enum class Quality { kDraft, kNormal, kHigh };
enum class Method { kHull, kVoxelColoring, kSpaceCarving, kRefine };

/// Surface that no camera sees: closed as the hull has it, or left out of mesh.ply. Without
/// silhouettes what is open also leaves out surface that is more likely wrong than right. Auto is
/// closed where there are silhouettes.
enum class Unseen { kAuto, kOpen, kClosed };

/// Where voxels lie: centred on the box, or from its lower corner on (carving/fit_grid.h), which is
/// the same for every scene with that box and voxels of that size.
enum class Lattice { kFit, kFixed };
/// Whether what surrounds the box is reconstructed too, on coarser grids. Auto does so where the
/// box was found (not given) and fewer than half of the views have silhouettes.
enum class Surroundings { kAuto, kOn, kOff };

const char* to_string(Quality quality);
const char* to_string(Method method);
const char* to_string(Unseen unseen);
const char* to_string(Lattice lattice);
const char* to_string(Surroundings surroundings);

/// How far mesh.ply may be from the uniform mesh; 0 keeps the uniform one.
struct MeshError {
  double value = 0;          ///< finite, >= 0
  bool world_units = false;  ///< else voxels
};

/// Reads "0.25" (voxels) or "0.002u" (world units). Throws UsageError.
MeshError parse_mesh_error(const std::string& text);

/// Reads "auto" (nothing) or a count of views. Throws UsageError.
std::optional<int> parse_views_may_miss(const std::string& text);

/// Reads "auto" (nothing) or pixels. Throws UsageError.
std::optional<double> parse_mask_offset(const std::string& text);

struct ReconstructOptions {
  std::filesystem::path scene;   ///< folder or file
  std::filesystem::path output;  ///< folder; made when it does not exist
  io::LoadSceneOptions load;
  BoxOptions box;
  std::optional<int> resolution;     ///< voxels along the box's longest side, >= 2
  std::optional<double> voxel_size;  ///< world units, > 0; excludes `resolution`
  /// kFixed needs one of the two, and a box that the scene or the user gives.
  Lattice lattice = Lattice::kFit;
  Quality quality = Quality::kNormal;
  std::optional<Method> method;  ///< default: hull for draft, refine otherwise
  /// Default: off for draft; else kAuto where masks' outlines disagree (cameras/refine_cameras.h).
  std::optional<RefineCameras> refine_cameras;
  Photometric photometric = Photometric::kAuto;
  /// Pixels by which outlines lie outside the masks'; nothing: measured (masks/mask_bias.h).
  std::optional<double> mask_offset;
  /// Silhouettes that may leave a point out and it stands all the same, 0 to
  /// carving::HullOptions::kMostMissing; nothing: as many as carving/missing_parts.h takes, and
  /// only where what masks show would be missing otherwise.
  std::optional<int> views_may_miss;
  bool keep_mask_holes = false;  ///< else masks/torn_masks.h mends masks that were given
  /// Of the photographs, standard deviation in 8-bit codes, 0 to 255; nothing: measured
  /// (photo/noise.h).
  std::optional<double> noise;
  bool keep_views = false;  ///< use views that disagree with the others too
  MeshError mesh_error;
  Unseen unseen = Unseen::kAuto;
  Surroundings surroundings = Surroundings::kOff;  ///< on: --method refine only
  /// How the sweep resamples photographs and what decides there; voxel coloring and space carving
  /// only.
  std::optional<projtex::Sampler> sampler;
  std::optional<int> supersample;  ///< n x n samples a voxel, 1 to projtex::kMaxSupersample
  std::optional<carving::Statistic> consistency;
  std::optional<visibility::SweepTest> visibility;
  std::optional<double> r_consistency;  ///< pixels, 0 to carving::kMaxSearchRadius
  bool fresh = false;     ///< do not go on from where an interrupted run of the same job came to
  bool evidence = false;  ///< write evidence.ply too: what confidence is computed from
  /// At which photographs are read, in (0, 1]; nothing: as the voxels need it
  /// (pipeline/image_scale.h).
  std::optional<double> image_scale;
  std::optional<std::int64_t> max_memory;  ///< bytes; nothing: default_max_memory()
  std::string device = "auto";             ///< auto, software or an index
  int threads = 0;                         ///< 0: one a core
  std::vector<std::string> tune;           ///< NAME=VALUE, see pipeline/tuning.h

  /// Throws UsageError naming the option.
  void validate() const;
  Method effective_method() const;
  /// Does the box stay as it is, however much larger than the object it may be?
  bool box_stands() const { return box.exact || lattice == Lattice::kFixed; }
};

using NamedValues = std::vector<std::pair<std::string, std::string>>;

/// The options as they take effect, but for scene and output.
NamedValues named_options(const ReconstructOptions& options);

/// Voxel size in pixels' footprints when neither resolution nor voxel size is given. Outlines are
/// known to a part of a pixel; without silhouettes depths of patches are all there is, which
/// smaller voxels make no better.
double footprint_factor(Quality quality, bool silhouettes);

/// Sum of the weights of the stages that this job will announce to its Progress.
double total_weight(const ReconstructOptions& options);

/// Runs the job and puts volume.vdb, mesh.ply, preview.png and report.json (and evidence.ply
/// on demand) into the output folder, all together at the end. Throws Error, UsageError or
/// Cancelled; earlier results then stay as they were (but see ResultFiles::commit) and no
/// half-written file is left. Refinement keeps the levels that are done in `.photohull-checkpoint`
/// there until the job has ended well.
Report reconstruct(const ReconstructOptions& options, Progress& progress);

}  // namespace photohull::pipeline
