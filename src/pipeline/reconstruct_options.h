// What a reconstruction may be asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carving/statistic.h"
#include "core/box.h"
#include "core/describe.h"
#include "io/load_scene.h"
#include "io/mesh/mesh_file_options.h"
#include "pipeline/complete_box.h"
#include "pipeline/part_number.h"
#include "pipeline/photometric.h"
#include "pipeline/refine_cameras.h"
#include "projtex/sampler.h"
#include "visibility/sweep_test.h"

namespace photohull::pipeline {

enum class Quality { kDraft, kNormal, kHigh };
enum class Method {
#define PHOTOHULL_METHOD(value, entry) value,
#include "pipeline/methods/methods.def"
};

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
/// Whether report.html is made.
enum class ReportPage { kOn, kOff };

const char* to_string(Quality quality);
const char* to_string(Method method);
const char* to_string(Unseen unseen);
const char* to_string(Lattice lattice);
const char* to_string(Surroundings surroundings);
const char* to_string(ReportPage page);

/// How far mesh.ply may be from the uniform mesh; 0 keeps the uniform one.
struct MeshError {
  double value = 0;          ///< finite, >= 0
  bool world_units = false;  ///< else voxels
};

/// The texture of files that hold one.
struct TextureChoice {
  bool off = false;
  int edge = 0;       ///< texels, a power of two; 0: as fine as the photographs are
  double detail = 1;  ///< fine differences of colour are multiplied by it
};

/// How other processes help with a refinement. It does not affect results and is not described.
struct SharedTiles {
  std::filesystem::path folder;  ///< that all of them see; the caller removes it
  int count = 0;                 ///< tiles that the surface is cut into at most; 0: nobody helps
};

/// What each is, with its unit and legal values, describe() tells.
struct ReconstructOptions {
  BoxOptions box;
  std::optional<int> resolution;
  std::optional<double> voxel_size;
  Lattice lattice = Lattice::kFit;
  Quality quality = Quality::kNormal;
  std::optional<Method> method;
  std::optional<RefineCameras> refine_cameras;  ///< by default see cameras/refine_cameras.h
  Photometric photometric = Photometric::kAuto;
  std::optional<double> mask_offset;  ///< nothing: measured (masks/mask_bias.h)
  std::optional<int> views_may_miss;  ///< nothing: by evidence (carving/missing_parts.h)
  bool keep_mask_holes = false;       ///< else they are mended (masks/torn_masks.h)
  std::optional<double> noise;        ///< nothing: measured (photo/noise.h)
  bool keep_views = false;
  MeshError mesh_error;
  Unseen unseen = Unseen::kAuto;
  Surroundings surroundings = Surroundings::kOff;
  std::optional<projtex::Sampler> sampler;
  std::optional<int> supersample;
  std::optional<carving::Statistic> consistency;
  std::optional<visibility::SweepTest> visibility;
  std::optional<double> r_consistency;
  /// Folders of results: of the moment before, whose surface this one's starts from, and of the
  /// same rig, whose cameras and gains hold. Empty: none.
  std::filesystem::path follow, rig;
  /// Of the whole that `follow` holds, this part alone, its voxels halved so many times.
  std::optional<PartNumber> part;
  int finer = 1;
  bool fresh = false;
  bool evidence = false;
  ReportPage report_page = ReportPage::kOn;
  /// Formats that the mesh is written in beside PLY (io/mesh/mesh_writers.h).
  std::vector<std::string> exports;
  TextureChoice texture;
  MeshFileOptions mesh_files;
  std::optional<double> image_scale;       ///< nothing: as the voxels need it (image_scale.h)
  std::optional<std::int64_t> max_memory;  ///< nothing: default_max_memory()
  std::string device = "auto";
  int threads = 0;
  std::vector<std::string> tune;  ///< see pipeline/tuning.h
  /// Folder in which refinement keeps the levels that are done, so that a job that was stopped goes
  /// on from there, and masks and refined cameras are kept for the next job with the same
  /// photographs; empty: none. It does not affect results and is not described.
  std::filesystem::path checkpoint;
  SharedTiles tiles;
  /// Where it is a part of the scene's box: what of this voxels fill. It is no choice of a user and
  /// not described.
  std::optional<Box> carved_box;
  double part_bricks = 0;  ///< about so many hold its surface; as carved_box

  /// Throws UsageError naming the option.
  void validate() const;
  Method effective_method() const;
  /// The folder whose cameras and gains hold; empty: none.
  const std::filesystem::path& rig_folder() const { return rig.empty() ? follow : rig; }
  /// Are the cameras those of that folder, without a refinement of their own?
  bool takes_rig_cameras() const {
    return !rig_folder().empty() &&
           refine_cameras.value_or(RefineCameras::kOff) == RefineCameras::kOff;
  }
  /// Does the box stay as it is, however much larger than the object it may be?
  bool box_stands() const { return box.exact || lattice == Lattice::kFixed; }
};

/// With those that say how the scene's photographs are read.
void describe(Described& to, ReconstructOptions& options, io::LoadSceneOptions& load);

using NamedValues = std::vector<std::pair<std::string, std::string>>;

/// The options as they take effect: those that are not at their defaults, and those that the report
/// always has.
NamedValues named_options(const ReconstructOptions& options, const io::LoadSceneOptions& load);

/// The same of those that change the results, in one line.
std::string option_line(const ReconstructOptions& options, const io::LoadSceneOptions& load);

/// Voxel size in pixels' footprints when neither resolution nor voxel size is given. Outlines are
/// known to a part of a pixel; without silhouettes depths of patches are all there is, which
/// smaller voxels make no better.
double footprint_factor(Quality quality, bool silhouettes);

}  // namespace photohull::pipeline
