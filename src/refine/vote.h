// Free space by voting of coarse depth maps.
#pragma once

#include <cstddef>
#include <span>

#include "core/grid.h"
#include "gpu/context.h"
#include "projtex/image_set.h"
#include "refine/label_space.h"

namespace photohull::refine {

struct VoteOptions {
  double ray_spacing = 1.0;    ///< between the rays of a view, voxels in the middle of the grid
  double again_spacing = 1.5;  ///< between the rays of vote_again
  double last_spacing = 2.5;   ///< likewise at the last level, where voxels are smallest
  double again_score = 0.7;  ///< likewise: below, the surface explains nothing, a ray finds nothing
  double tap_spacing = 0.7;  ///< of the patches across the rays, voxels
  double nearest_partner = 4;  ///< degrees between a view and those that its rays are matched with
  int tiles = 1;               ///< along either side of a view, each matched with views of its own
  double best_pairs = 0.5;     ///< share of the pairs of views that the score is the mean of
  double least_score = 0.5;    ///< of the best sample on a ray; below, the ray says nothing
  double distinct_by = 0.25;   ///< lead over the second best that gives a ray full weight
  double band = 1.5;          ///< voxels; at most kBand: a ray's say ends that far behind its depth
  double least_weight = 1.5;  ///< sum of the rays' weights below which a voxel stays
  double again_weight = 2;    ///< likewise, for what vote_again adds
  double freeing_weight = 3;  ///< and for what it frees: plain surface is not explained either
  /// Of trying neighbours' planes, after a ray has been searched by itself, at all levels but the
  /// last, and at that.
  int rounds = 2, last_rounds = 1;
  int bare_reach =
      0;  ///< rays between one that meets no surface and votes again, and one that does
};

/// The hull without what the views' depth maps see through: each view's rays are matched with views
/// near it by 3 x 3 patches across the ray, and a voxel takes the weighted mean of its signed
/// distances along them (voxels, not below the hull's). Only the signs and the distances near zero
/// are meaningful, and a stray ray may leave pockets in the body that no path joins to the outside
/// (fill_cavities). `cameras` and `images` are in the same order, `noise_sigma` > 0 in square-root
/// encoding. All bricks that are not outside are stored. Throws Error when the device cannot hold a
/// batch.
SparseVolume vote_free_space(gpu::Context& context, const SparseVolume& hull,
                             const projtex::ImageSet& images, std::span<const Camera> cameras,
                             double noise_sigma, const VoteOptions& options);

/// Space that no silhouette bounds: free before the depths that the views' rays find, solid in a
/// thin shell behind them, and elsewhere as the smallest surface has it (label_space), so that what
/// is unknown is not solid unless solid space encloses it. Distances are as vote_free_space gives
/// them. Throws as that does.
SparseVolume label_by_votes(gpu::Context& context, const SparseVolume& hull,
                            const projtex::ImageSet& images, std::span<const Camera> cameras,
                            double noise_sigma, const VoteOptions& options,
                            const LabelOptions& label);

struct Revision {
  std::size_t added = 0, freed = 0;  ///< voxels
};

/// Votes anew on a finer grid than the one `volume` comes from, by rays that its surface does
/// not explain: thin parts before the surface, which coarser voxels took for free space, come back,
/// and bodies that only coarser voxels could not look past go. Rays that the surface explains vote
/// too. `volume` is on the hull's grid.
Revision vote_again(gpu::Context& context, SparseVolume& volume, const SparseVolume& hull,
                    const projtex::ImageSet& images, std::span<const Camera> cameras,
                    double noise_sigma, VoteOptions options);

}  // namespace photohull::refine
