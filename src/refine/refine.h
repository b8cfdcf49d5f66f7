// Surface refinement by photo-consistency on tangent patches, coarse to fine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "carving/hull.h"
#include "core/grid.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "projtex/image_set.h"
#include "refine/close_unseen.h"
#include "refine/displacement.h"
#include "refine/fit_patches.h"
#include "refine/look_through.h"
#include "refine/match.h"
#include "refine/restore.h"
#include "refine/rims.h"
#include "refine/seat.h"
#include "refine/settle.h"
#include "refine/thin_hull.h"
#include "refine/unproven.h"
#include "refine/vote.h"

namespace photohull::refine {

/// How rays vote where no silhouettes bound space. Of those that meet no surface, those vote again
/// that are at most `reach` rays from one that does, at the last level `last_reach`.
struct OpenVoteOptions {
  int rounds = 5;  ///< in the place of VoteOptions::rounds, at all levels but the last
  int tiles = 6;   ///< in the place of VoteOptions::tiles
  int reach = kAnyReach, last_reach = 8;
  static constexpr int kAnyReach = 1 << 20;
};

struct RefineOptions {
  /// Do the silhouettes, where there are any, bound what they show (carving::silhouettes_bound)?
  bool bounded = true;
  /// Voxel sizes, each half the one before; the last is the result's. 0: as many as bring the first
  /// grid to kCoarsestVoxels along its longest side, and without silhouettes to voxels of some
  /// pixels, if that leaves more than kFewestVoxels.
  int levels = 0;
  static constexpr int kCoarsestVoxels = 80, kFewestVoxels = 20;
  int coarse_iterations = 3;  ///< of matching and moving, at the first level
  int middle_iterations = 2;
  int fine_iterations = 1;  ///< at the last level
  int coarse_offsets = 11;  ///< places along the normal that are tried
  int fine_offsets = 7;
  double step = 0.5;           ///< between them, voxels
  int aggregations = 2;        ///< passes of averaging scores over neighbours
  double noise_sigma = 0.003;  ///< of the images, square-root encoding
  bool voting = true;          ///< start from coarse depth maps' free space instead of the hull
  VoteOptions vote;
  OpenVoteOptions open;
  LabelOptions label;   ///< where there are no silhouettes; 0 iterations: unknown space is solid
  bool closing = true;  ///< of surface that no camera sees
  CloseOptions close;
  RestoreOptions restore;
  RimOptions rims;
  ThinHullOptions thin;
  UnprovenOptions unproven;
  MatchOptions match;
  LookOptions look;
  SeatOptions seat;  ///< after fitting
  SettleOptions settle;
  int photometric = 1;  ///< iterations of fitting patches, at the end; fewer when they stop helping
  FitOptions fit;
  PeakOptions peak;
  RegularizeOptions regularize;

  /// Throws UsageError naming the option.
  void validate() const;
};

struct LevelReport {
  double voxel_size = 0;      ///< world units
  double seconds = 0;         ///< wall
  std::int64_t surfels = 0;   ///< of the last iteration
  std::int64_t samples = 0;   ///< texture samples
  std::int64_t bricks = 0;    ///< stored at the end
  std::int64_t restored = 0;  ///< voxels of the hull that silhouettes or votes brought back
  std::int64_t freed = 0;     ///< voxels before surface that views see through them
  /// Bricks of the level's surface that the next level matches, and that it does not: below the
  /// images' sampling, without texture, flat and certain.
  std::int64_t split = 0, settled_pixels = 0, settled_plain = 0, settled_flat = 0;
  double mean_move = 0;  ///< of the last iteration, voxels
  double evidence = 0;   ///< share of its surfels that the photographs say a place for
};

/// One pass of the photometric refinement.
struct FitReport {
  double seconds = 0;                      ///< wall
  double held_before = 0, held_after = 0;  ///< mean score of the held-out views
  double mean_move = 0;                    ///< voxels
  bool kept = false;                       ///< did the next pass find the surface better?
};

struct RefineReport {
  int resumed = 0;  ///< levels that an earlier run had done
  std::vector<LevelReport> levels;
  std::vector<FitReport> fits;
};

/// Where finished levels are kept until the job is done.
struct CheckpointFile {
  std::filesystem::path path;
  std::string job;  ///< what makes two jobs the same: scene, photographs, options, program
};

/// The visual hull on a grid.
using HullAt = std::function<SparseVolume(const GridSpec&)>;

/// The surface that the photographs agree on, on the grid `finest`, from the hull's silhouettes
/// (one per camera, parts may be empty) inwards. A level starts from the one before, takes back
/// what only finer voxels of the hull show, and then matches the surface's tangent patches between
/// the views that see them and moves its signed distance, a few times over. Surface that no camera
/// sees is closed smoothly. Deterministic on one device. With a `checkpoint`, levels that an
/// interrupted run of the same job finished are not done again; the caller removes the file. Throws
/// Cancelled, UsageError for options, and what hull_at throws.
SparseVolume refine_surface(gpu::Context& context, const GridSpec& finest, const HullAt& hull_at,
                            std::span<const carving::Silhouette> silhouettes,
                            const projtex::ImageSet& images, std::span<const Camera> cameras,
                            const RefineOptions& options, Progress& progress,
                            RefineReport* report = nullptr,
                            const CheckpointFile* checkpoint = nullptr);

}  // namespace photohull::refine
