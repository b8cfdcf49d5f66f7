// Surface refinement by photo-consistency on tangent patches, coarse to fine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "carving/hull.h"
#include "core/describe.h"
#include "core/grid.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "projtex/image_set.h"
#include "projtex/out_of_core.h"
#include "refine/close_unseen.h"
#include "refine/displacement.h"
#include "refine/fit_patches.h"
#include "refine/follow.h"
#include "refine/hull_prior.h"
#include "refine/look_through.h"
#include "refine/match.h"
#include "refine/restore.h"
#include "refine/seat.h"
#include "refine/settle.h"
#include "refine/thin_hull.h"
#include "refine/unproven.h"
#include "refine/vote.h"

namespace photohull::refine {

class SharedWork;

/// How rays vote where no silhouettes bound space.
struct OpenVoteOptions {
  int tiles = 6;
  int reach = VoteOptions::kAnyReach, last_reach = 8;
};

inline void describe(Described& to, OpenVoteOptions& o) {
  to.number("tiles", &o.tiles, from_to(1, 32), "",
            "the same as vote.tiles where there are no masks");
  to.number("reach", &o.reach, from_to(0, VoteOptions::kAnyReach), "rays",
            "the same as vote.bare_reach where there are no masks, at all levels but the last");
  to.number("last_reach", &o.last_reach, from_to(0, VoteOptions::kAnyReach), "rays",
            "the same as vote.bare_reach where there are no masks, at the last level");
}

struct RefineOptions {
  /// Do the silhouettes, where there are any, bound what they show (carving::silhouettes_bound)?
  /// No choice of a user.
  bool bounded = true;
  int levels = 0;
  FollowOptions follow;
  static constexpr int kCoarsestVoxels = 80, kFewestVoxels = 20;
  int coarse_iterations = 3, fine_iterations = 1;
  int coarse_offsets = 11, fine_offsets = 7;
  double step = 0.5;
  int aggregations = 2;
  double noise_sigma = 0.003;
  bool voting = true;
  VoteOptions vote;
  OpenVoteOptions open;
  LabelOptions label;
  bool closing = true;
  CloseOptions close;
  RestoreOptions restore;
  HullPriorOptions hull_prior;
  ThinHullOptions thin;
  UnprovenOptions unproven;
  MatchOptions match;
  LookOptions look;
  SeatOptions seat;
  SettleOptions settle;
  int fit_passes = 1;
  FitOptions fit;
  PeakOptions peak;
  RegularizeOptions regularize;

  /// Throws UsageError naming the option.
  void validate() const;
};

inline void describe(Described& to, RefineOptions& o) {
  to.affects(Stage::kSurface);
  // Automatic: as many as bring the first grid to kCoarsestVoxels along its longest side, and
  // without silhouettes to voxels of some pixels, if that leaves more than kFewestVoxels.
  to.number("levels", &o.levels, from_to(0, 8), "",
            "sizes of voxels, each half the one before; the last is the result's")
      .zero = "automatic";
  to.group("follow", o.follow);
  to.number("coarse_iterations", &o.coarse_iterations, at_least(1), "",
            "iterations of matching and moving, at the first level");
  to.number("fine_iterations", &o.fine_iterations, at_least(1), "",
            "iterations of matching and moving, at the last level");
  to.number("coarse_offsets", &o.coarse_offsets, from_to(3, 64), "",
            "places along the normal that are tried at the first level");
  to.number("fine_offsets", &o.fine_offsets, from_to(3, 64), "",
            "places along the normal that are tried at later levels");
  to.number("step", &o.step, above(0, 2), "voxels",
            "distance between the places along the normal that are tried");
  to.number("aggregations", &o.aggregations, at_least(0), "",
            "passes of averaging scores over neighbours");
  to.number("noise_sigma", &o.noise_sigma, above(0), "",
            "standard deviation of the images' noise, square roots of linear light; measured "
            "where it is not given");
  to.flag("voting", &o.voting, "start from coarse depth maps' free space instead of the hull");
  to.group("vote", o.vote);
  to.group("open", o.open);
  to.group("label", o.label);
  to.flag("closing", &o.closing, "close surface that no camera sees smoothly");
  to.group("close", o.close);
  to.group("restore", o.restore);
  to.group("hull_prior", o.hull_prior);
  to.group("thin", o.thin);
  to.group("unproven", o.unproven);
  to.group("match", o.match);
  to.group("look", o.look);
  to.group("seat", o.seat);
  to.group("settle", o.settle);
  to.number("fit_passes", &o.fit_passes, from_to(0, 100), "",
            "passes of fitting patches to the photographs, at the end; fewer when they stop "
            "helping");
  to.group("fit", o.fit);
  to.group("peak", o.peak);
  to.group("regularize", o.regularize);
}

inline void RefineOptions::validate() const { check_described(*this); }

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
  std::optional<HullTrust> hull_trust;  ///< as pull_to_hull returns it; nothing: it was not asked
};

/// One fit pass of the refinement.
struct FitReport {
  double seconds = 0;                      ///< wall
  double held_before = 0, held_after = 0;  ///< mean score of the held-out views
  double mean_move = 0;                    ///< voxels
  std::optional<HullTrust> hull_trust;     ///< as of LevelReport
  bool kept = false;                       ///< did the next pass find the surface better?
};

struct RefineReport {
  int resumed = 0;        ///< levels that an earlier run had done
  bool followed = false;  ///< did it start from the moment before?
  std::vector<LevelReport> levels;
  std::vector<FitReport> fits;

  /// Of its last step that asked.
  std::optional<HullTrust> hull_trust() const;
};

/// Where finished levels are kept until the job is done.
struct CheckpointFile {
  std::filesystem::path path;
  std::string job;  ///< what makes two jobs the same: scene, photographs, options, program
};

/// The visual hull on a grid.
using HullAt = std::function<SparseVolume(const GridSpec&)>;

/// The surface of a whole scene on coarser voxels, of which a part is refined.
struct WholeSurface {
  const SparseVolume& volume;
  /// Of the whole's grid at the part's voxels: that the part's grid begins with.
  glm::ivec3 first_voxel{0};
  int levels = 1;  ///< by which the part's voxels are finer, each halves them
  /// Of each camera, in world units: what of the surface lies outside the part's grid.
  std::span<const DepthMap> beside;
  std::optional<double> hull_trust;  ///< at the part's voxels, as the whole's last step tells
};

/// What a surface is refined from. The parts outlive the call.
struct RefineScene {
  const GridSpec& finest;  ///< the result's
  HullAt hull_at;
  std::span<const carving::Silhouette> silhouettes;  ///< one a camera, parts may be empty
  const projtex::ImageSet& images;                   ///< one a camera
  std::span<const Camera> cameras;
  /// The same views' photographs, larger, for levels whose voxels ask for them; null: none.
  projtex::OutOfCorePhotographs* larger = nullptr;
  const MomentBefore* before = nullptr;  ///< null: it is not known
  SharedWork* shared = nullptr;          ///< by way of which other processes help; null: none does
  const WholeSurface* whole = nullptr;   ///< of which this is a part; null: it is the whole itself
};

/// The surface that the photographs agree on, on the finest grid, from the hull inwards. A level
/// starts from the one before, takes back what only finer voxels of the hull show, and then matches
/// the surface's tangent patches between the views that see them and moves its signed distance, a
/// few times over. Surface that no camera sees is closed smoothly. Deterministic on one device.
/// Where the surface of the moment before is known, silhouettes bound space, and enough of it lies
/// in them (FollowOptions), the last levels start from it and the others are not done. Where the
/// grid is a part of a whole whose surface is known, that is what the levels after it start from,
/// and what lies outside the part hides it from views and covers their silhouettes. With a
/// `checkpoint`, levels that an interrupted run of the same job finished are not done again; the
/// caller removes the file. Throws Cancelled, UsageError for options, and what hull_at throws.
SparseVolume refine_surface(gpu::Context& context, const RefineScene& scene,
                            const RefineOptions& options, Progress& progress,
                            RefineReport* report = nullptr,
                            const CheckpointFile* checkpoint = nullptr);

}  // namespace photohull::refine
