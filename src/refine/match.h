// Photo-consistency of surface patches against offsets along their normals.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "gpu/context.h"
#include "photo/noise.h"
#include "projtex/image_set.h"
#include "shared/bake.h"
#include "shared/refine.h"

namespace photohull::refine {

struct MatchOptions {
  double least_spacing = 0.4;  ///< of a patch's taps, voxels
  double pixel_spacing = 1.0;  ///< of a patch's taps, pixels of the reference view
  double most_bend = 1.0;      ///< largest curvature that a patch follows, 1 / voxel
  double best_pairs = 0.4;     ///< share of the pairs of views that the score is the mean of
  double shift = 1.5;          ///< of the receiver along its normal, voxels
  double depth_bias = 2.5;     ///< voxels
  double least_cosine = 0.2;   ///< between a normal and a camera's direction
  double seen_cosine = 0.02;   ///< likewise, above which a camera sees the surface at all
  double nearest_angle = 5;    ///< degrees between the reference and a view compared with it
  double farthest_angle = 70;  ///< degrees
  double sparse_angle = 75;  ///< degrees that refine_surface widens it to where cameras are sparse
  double duplicate_angle = 8;  ///< degrees between views that tell nearly the same
};

/// What raises the variance of patches in their correlation: that of rounding to 8 bits, or the
/// noise's where it is smaller. Not all of the noise's: it would lower scores where photographs are
/// noisy, true and false ones alike, and Matches::texture says what noise leaves.
inline double variance_floor(double noise_sigma) {
  return std::min(noise_sigma * noise_sigma, kRoundingNoise * kRoundingNoise);
}

/// Offsets along the normals, in voxels: first, first + step, ... (count of them).
struct OffsetRange {
  double first = 0, step = 0.5;
  int count = 1;
  double at(double index) const { return first + step * index; }
};

struct Matches {
  OffsetRange range;
  std::vector<float> scores;   ///< vertices x range.count; kNoScore where nothing is known
  std::vector<float> texture;  ///< per vertex, [0, 1]: share of a patch's variance that noise does
                               ///< not explain; 1 where nothing is known
  std::int64_t samples = 0;    ///< texture samples taken

  std::span<const float> of(std::size_t vertex) const {
    return {scores.data() + vertex * std::size_t(range.count), std::size_t(range.count)};
  }
};

/// The views that each vertex of `mesh` (with normals) is matched in, sharp ones first where
/// others are blurred (reference::choose_views). Visibility by depth maps of the mesh itself.
std::vector<shaders::MatchChoice> choose_views(gpu::Context& context, const GridSpec& grid,
                                               const TriMesh& mesh, const projtex::ImageSet& images,
                                               std::span<const Camera> cameras,
                                               const MatchOptions& options);

/// Score in [-1, 1] of every surfel (voxels; positions and unit normals), moved by each offset, in
/// the views chosen for it. Patches bend as `bends` (one per surfel, see curvatures()) says; empty:
/// they are planes.
Matches match_patches(gpu::Context& context, const GridSpec& grid,
                      std::span<const shaders::BakeVertex> surfels,
                      std::span<const glm::vec3> bends,
                      std::span<const shaders::MatchChoice> choices,
                      const projtex::ImageSet& images, std::span<const Camera> cameras,
                      double noise_sigma, const OffsetRange& range, const MatchOptions& options);

}  // namespace photohull::refine
