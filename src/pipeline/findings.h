// What each stage of a reconstruction found out beside its value; the report is made of these.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assess/verdict.h"
#include "cameras/look_at_cameras.h"
#include "core/box.h"
#include "core/camera.h"
#include "core/scene.h"
#include "pipeline/input_hashes.h"

namespace photohull::pipeline {

struct SceneFindings {
  std::string path, format;
  std::vector<InputFile> inputs;
  int listed = 0;       ///< photographs, by the scene's file
  int scaled = 0;       ///< as Scene::scaled
  int passed_over = 0;  ///< as Scene::passed_over
};

/// Where a view's mask came from, and how sure it is (MaskJudgement).
struct MaskFinding {
  std::string view, source;
  double confidence = 0;
};

struct ViewFindings {
  int views = 0;                                 ///< that could be decoded
  std::vector<LeftOutView> left_out;             ///< for they cannot be used
  double smallest_scale = 1, largest_scale = 1;  ///< at which photographs were read
  double matched_scale = 1;  ///< the smallest at which the surface was matched in them
  double noise_sigma = 0;    ///< square-root-encoded units of full scale
  std::string mask_source;
  double mask_confidence = 0;
  std::vector<MaskFinding> masks;  ///< of each view
  int masks_mended = 0;            ///< by masks/torn_masks.h
};

struct CameraFindings {
  /// Pixels (cameras/look_at_cameras.h, tangent_disagreement); NaN where it was not looked at.
  double mask_disagreement = NAN;
  FeatureAgreement features;  ///< where outlines tell nothing
  std::string refinement;     ///< JSON (pipeline/refine_cameras.h); empty: none was tried
  double moved = 0;           ///< by a refinement that is used, pixels
  double moved_alike = 0;     ///< of it what all views have in common
};

/// A view whose outline is off what the other views' say.
struct OutlineRoom {
  std::string view;
  double pixels = 0;  ///< by which its outline was widened
};

/// What silhouettes show of thin parts, and where they disagree (masks/mask_lines.h,
/// carving/missing_parts.h).
struct ThinFindings {
  std::int64_t line_pixels = 0;      ///< of all masks: parts narrower than about two pixels
  std::int64_t looked_at = 0;        ///< places of the foreground
  std::int64_t unexplained = 0;      ///< of these, without a point that all silhouettes bear
  std::int64_t placed = 0;           ///< of the unexplained, given the place that most views bear
  std::int64_t restored_pixels = 0;  ///< of lines that eaten masks had lost, in all views
  std::string worst_view;            ///< with the largest share left unexplained; empty: none
};

struct SilhouetteFindings {
  std::vector<std::pair<std::string, double>> sharpness;  ///< of each view (views/sharpness.h)
  double mask_offset = 0;  ///< pixels by which the masks' outlines were moved outward
  /// Views whose silhouettes contradict the others', or that are strongly blurred.
  std::vector<std::string> left_out;
  std::vector<std::string> masks_left_out;  ///< of views whose cameras are right
  std::vector<OutlineRoom> outline_room;    ///< of views whose outlines are off
  ThinFindings thin;
  double contradiction = 0;  ///< share of the silhouettes' rays that other silhouettes leave empty
  assess::CommonError common_error;  ///< of the outlines of the views that are left
};

struct HullFindings {
  std::int64_t nodes_tested = 0, bricks_evaluated = 0;
  std::int64_t samples = 0;  ///< look-ups in silhouettes
};

/// What a kernel, or a drawing, took.
struct KernelFindings {
  std::string name;
  std::int64_t launches = 0, groups = 0;  ///< groups: work groups, in all; 0 of drawings
  double seconds = 0, cpu_seconds = 0;    ///< up to the end of the work, of all threads
};

/// The device's work. Each launch and each download is waited for.
struct DeviceFindings {
  std::vector<KernelFindings> kernels;
  std::int64_t uploads = 0, bytes_up = 0, downloads = 0, bytes_down = 0;
};

struct PhotometricFindings {
  std::string json;  ///< pipeline/photometric.h; empty: not asked for
  std::string line;  ///< the same, for the screen
};

/// How the plane sweep looked at the photographs.
struct SamplingFindings {
  std::string sampler;
  int supersample = 0;
  std::string consistency;
  std::string visibility;
  double r_consistency = 0;  ///< pixels
};

struct SweepFindings {
  std::optional<SamplingFindings> sampling;
  int sweeps = 0;
  std::int64_t voxels_judged = 0, voxels_carved = 0, voxels_undecided = 0;
};

/// One level of the refinement, coarsest first.
struct RefineLevelFindings {
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

/// One fit pass of the refinement.
struct RefineFitFindings {
  double wall_seconds = 0;
  double held_out = 0, held_out_fitted = 0;  ///< mean scores of the views that were held out
  double mean_move = 0;                      ///< voxels
  bool kept = false;
};

struct RefineFindings {
  using HullTrust = std::array<double, 5>;
  int resumed_levels = 0;  ///< of the levels, done by an earlier run that was interrupted
  std::optional<HullTrust> hull_trust;  ///< as refine::RefineReport has it
  bool followed = false;                ///< did the first level start from the moment before?
  std::vector<RefineLevelFindings> levels;
  std::vector<RefineFitFindings> fits;
};

/// What the method that carved says of it (pipeline/methods).
struct SurfaceFindings {
  std::int64_t samples = 0;  ///< of textures
  SweepFindings sweep;
  RefineFindings refine;
};

/// Distances between mesh.ply and the uniform mesh, both ways, in voxels.
struct MeshErrorFindings {
  double limit = 0;  ///< as asked for
  double mean = 0, p95 = 0, p999 = 0, max = 0;
};

struct ExtractFindings {
  std::int64_t sharpened_vertices = 0;  ///< moved onto sharp edges, or onto what meets there
  std::int64_t stem_vertices = 0;       ///< put to where lines say (carving/fit_stems.h)
};

struct ColourFindings {
  double unseen_share = 0;  ///< of the vertices
};

/// Pieces of an open mesh that too few photographs support, which went.
struct IslandFindings {
  std::int64_t pieces = 0;
  double area_share = 0;  ///< of the open mesh's area
};

struct MeshFindings {
  std::int64_t vertices = 0, triangles = 0;
  std::int64_t uniform_triangles = 0;  ///< before simplification
  ExtractFindings extract;
  ColourFindings colour;
  IslandFindings islands;
  std::optional<MeshErrorFindings> error;
};

/// From where the model can be looked at.
struct CameraPose {
  std::string name;
  Camera camera;  ///< of the whole photograph as read, but for its lens distortion
};
struct LookFindings {
  std::vector<CameraPose> cameras;  ///< as they took effect
  glm::dvec3 up{0, 0, 1};           ///< unit, world: upward in the photographs (render/scene_up.h)
  glm::dvec3 up_axis{0, 0, 1};      ///< the world axis that is upward in files that have one
  std::string main_view;            ///< that shows the model best
};

/// The texture of files that hold one (texture/texture_mesh.h).
struct TextureFindings {
  std::int64_t triangles = 0;  ///< of the mesh in these files
  std::int64_t pages = 0;
  int width = 0, height = 0;  ///< of every page, texels
  double scale = 1;           ///< texels for a pixel of the photographs as read, along each side
  std::int64_t charts = 0;
  std::int64_t views = 0;   ///< photographs that colours come from
  std::int64_t texels = 0;  ///< that show the surface
  double filled_share = 0;  ///< of these, with the vertices' colours: no photograph is clear there
  double unseen_share = 0;  ///< of the area: triangles that no photograph shows clearly
  std::int64_t bytes = 0;   ///< that the stage took beside meshes, photographs and finished pages
};

/// A coarser grid around the box (pipeline/surroundings.h).
struct ShellFindings {
  Box box;
  double voxel_size = 0;  ///< world units
  glm::ivec3 voxels{0};
  std::int64_t triangles = 0;  ///< before simplification
  double area_share = 0;       ///< of the whole mesh's area, [0, 1]
};

struct VerdictFindings {
  assess::Verdict verdict;
  std::string json;            ///< the same with what it rests on (pipeline/self_check.h)
  std::string missing_view;    ///< that missing.png shows; empty: there is none
  std::string explained_view;  ///< that explained.png shows; empty: there is none
};

}  // namespace photohull::pipeline
