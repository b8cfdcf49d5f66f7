// Photo-consistency of surface patches against offsets along their normals.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "gpu/context.h"
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
  double farthest_angle = 50;  ///< degrees
  double sparse_angle = 75;  ///< degrees that refine_surface widens it to where cameras are sparse
  double duplicate_angle = 8;  ///< degrees between views that tell nearly the same
};

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
  std::vector<bool> seen;      ///< per vertex: by any camera, however flatly
  std::int64_t samples = 0;    ///< texture samples taken

  std::span<const float> of(std::size_t vertex) const {
    return {scores.data() + vertex * std::size_t(range.count), std::size_t(range.count)};
  }
};

/// Score in [-1, 1] of every vertex of `mesh` (with normals) moved by each offset. Visibility by
/// depth maps of the mesh itself. Patches bend as `bends` (one per vertex, see curvatures()) says;
/// empty: they are planes. `choices` receives the views that each vertex was matched in.
Matches match_patches(gpu::Context& context, const GridSpec& grid, const TriMesh& mesh,
                      std::span<const glm::vec3> bends, const projtex::ImageSet& images,
                      std::span<const Camera> cameras, double noise_sigma, const OffsetRange& range,
                      const MatchOptions& options,
                      std::vector<shaders::MatchChoice>* choices = nullptr);

/// Score of each surfel (voxels; position.w is 1) in the two views of its choice, on planes.
std::vector<float> correlate_pairs(gpu::Context& context, const GridSpec& grid,
                                   std::span<const shaders::BakeVertex> surfels,
                                   std::span<const shaders::MatchChoice> pairs,
                                   const projtex::ImageSet& images, std::span<const Camera> cameras,
                                   double noise_sigma, const MatchOptions& options);

}  // namespace photohull::refine
