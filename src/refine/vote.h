// Free space by voting of coarse depth maps.
#pragma once

#include <cstddef>

#include "core/describe.h"
#include "core/grid.h"
#include "gpu/context.h"
#include "projtex/photographs.h"
#include "refine/kernels/label_space.h"

namespace photohull::refine {

class SharedWork;

struct VoteOptions {
  double ray_spacing = 1, again_spacing = 1.5, last_spacing = 2.5, again_score = 0.7;
  double tap_spacing = 0.7, best_pairs = 0.5, least_score = 0.5;
  /// The least angle, in degrees, between a view and those that its rays are matched with. It is no
  /// option: the surroundings of a box set it by themselves.
  double nearest_partner = 4;
  double distinct_by = 0.25, band = 1.5;
  double least_weight = 1.5, again_weight = 2, freeing_weight = 3;
  int rounds = 2, last_rounds = 1, tiles = 1, bare_reach = 0;
  static constexpr int kAnyReach = 1 << 20;  ///< rays: wherever they are
};

inline void describe(Described& to, VoteOptions& o) {
  to.number("ray_spacing", &o.ray_spacing, above(0, 1000), "voxels",
            "distance between the rays of a view, in the middle of the grid");
  to.number("again_spacing", &o.again_spacing, above(0, 1000), "voxels",
            "distance between the rays that vote again, where no surface explains them");
  to.number("last_spacing", &o.last_spacing, above(0, 1000), "voxels",
            "distance between the rays that vote again at the last level, where voxels are "
            "smallest");
  to.number("again_score", &o.again_score, from_to(-1, 1), "",
            "score of a ray below which the surface does not explain it and it votes again");
  to.number("tap_spacing", &o.tap_spacing, above(0, 1000), "voxels",
            "distance between the taps of the patches across the rays");
  to.number("best_pairs", &o.best_pairs, above(0, 1), "",
            "share of the pairs of views that a score is the mean of");
  to.number("least_score", &o.least_score, from_to(-1, 1), "",
            "score of the best sample on a ray below which the ray says nothing");
  to.number("distinct_by", &o.distinct_by, above(0), "",
            "lead over the second best sample that gives a ray full weight");
  to.number("band", &o.band, above(0, SparseVolume::kBand), "voxels",
            "distance behind its depth at which what a ray says ends");
  to.number("least_weight", &o.least_weight, above(0), "",
            "sum of the rays' weights below which a voxel stays");
  to.number("again_weight", &o.again_weight, above(0), "",
            "sum of the weights of rays that vote again below which they add nothing");
  to.number("freeing_weight", &o.freeing_weight, above(0), "",
            "sum of the weights of rays that vote again below which they free nothing, for surface "
            "without texture is not explained either");
  to.number("rounds", &o.rounds, from_to(0, 20), "",
            "rounds of trying neighbours' planes after a ray has been searched by itself, at all "
            "levels but the last");
  to.number("last_rounds", &o.last_rounds, from_to(0, 20), "",
            "rounds of trying neighbours' planes at the last level");
  to.number(
      "tiles", &o.tiles, from_to(1, 32), "",
      "parts along either side of a photograph whose rays are matched with views of their own");
  to.number("bare_reach", &o.bare_reach, from_to(0, VoteOptions::kAnyReach), "rays",
            "greatest distance between a ray that meets no surface and votes again, and one that "
            "meets some");
}

/// The hull without what the views' depth maps see through: each view's rays are matched with views
/// near it by 3 x 3 patches across the ray, and a voxel takes the weighted mean of its signed
/// distances along them (voxels, not below the hull's). Only the signs and the distances near zero
/// are meaningful, and a stray ray may leave pockets in the body that no path joins to the outside
/// (fill_cavities). The photographs' noise is > 0. All bricks that are not outside are stored.
/// Throws Error when the device cannot hold a batch. Here and below, `shared` is by way of which
/// others may help; null: nobody does.
SparseVolume vote_free_space(gpu::Context& context, const SparseVolume& hull,
                             const projtex::Photographs& photographs, const VoteOptions& options,
                             SharedWork* shared = nullptr);

/// Space that no silhouette bounds: free before the depths that the views' rays find, solid in a
/// thin shell behind them, and elsewhere as the smallest surface has it (label_space), so that what
/// is unknown is not solid unless solid space encloses it. Distances are as vote_free_space gives
/// them. Throws as that does.
SparseVolume label_by_votes(gpu::Context& context, const SparseVolume& hull,
                            const projtex::Photographs& photographs, const VoteOptions& options,
                            const LabelOptions& label, SharedWork* shared = nullptr);

struct Revision {
  std::size_t added = 0, freed = 0;  ///< voxels
};

/// Votes anew on a finer grid than the one `volume` comes from, by rays that its surface does
/// not explain: thin parts before the surface, which coarser voxels took for free space, come back,
/// and bodies that only coarser voxels could not look past go. Rays that the surface explains vote
/// too. `volume` is on the hull's grid.
Revision vote_again(gpu::Context& context, SparseVolume& volume, const SparseVolume& hull,
                    const projtex::Photographs& photographs, VoteOptions options,
                    SharedWork* shared = nullptr);

}  // namespace photohull::refine
