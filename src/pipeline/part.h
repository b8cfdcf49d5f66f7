// A part of a scene whose whole is known on coarser voxels: models larger than memory, part by
// part.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/box.h"
#include "core/camera.h"
#include "core/depth_map.h"
#include "core/grid.h"
#include "core/mesh.h"
#include "core/prepared_view.h"
#include "gpu/context.h"
#include "pipeline/part_number.h"

namespace photohull::pipeline {

/// Bricks of a lattice, from `first` up to `end`.
struct BrickRange {
  glm::ivec3 first{0}, end{0};

  bool contains(const glm::ivec3& brick) const {
    return glm::all(glm::greaterThanEqual(brick, first)) && glm::all(glm::lessThan(brick, end));
  }
};

/// The grid of a volume cut into ranges of about as many stored bricks each, `part.count` of them:
/// always across the longest side of what is stored. They leave none of the grid out, nor do they
/// overlap. Throws Error where there are fewer layers of bricks than that.
BrickRange range_of_part(const SparseVolume& whole, const PartNumber& part);

/// Voxels around a part's own that are refined with it, so that what patches and smoothing reach
/// over its border is there: at least so many.
inline constexpr int kHaloVoxels = 16;

/// What a part is made of.
struct Part {
  SparseVolume near;  ///< the whole's surface in the part and about it, on the whole's grid
  /// Voxels of the whole's grid at its surface, outside the part's grid.
  std::vector<glm::ivec3> beside;
  GridSpec grid;              ///< of the part, its halo included
  glm::ivec3 first_voxel{0};  ///< of the whole's grid at such voxels, that `grid` begins with
  BrickRange own;             ///< bricks of `grid` that are the part's own
  Box whole_box;              ///< that the whole was made in
  double bricks = 0;          ///< about so many of `grid` hold its surface
  std::optional<double> hull_trust;  ///< of the whole (refine::WholeSurface)
  Box box;  ///< that the grid's voxels fill, as far as it lies in the whole's
};

/// `box`: that the whole was made in. `levels`: how often its voxels are halved.
Part cut_part(const SparseVolume& whole, const Box& box, const PartNumber& part, int levels);

/// The surface of the whole whose results are in the folder, without its distances: enough for the
/// two below. Throws as read_vdb_surface does.
SparseVolume bricks_of_whole(const std::filesystem::path& folder);

/// How few parts the whole has to be cut into, at voxels that are halved so many times, for each to
/// have at most `room` (> 0) of its surface, that around the part's own included, and to fit into a
/// lattice. Nothing: no number does.
std::optional<int> fewest_parts(const SparseVolume& whole, int levels, double room);

/// The share of the whole's surface that a part has, that around its own included.
double share_of_part(const SparseVolume& whole, const PartNumber& part, int levels);

/// Of each camera, in world units: what of the whole lies outside the part's grid. Throws Error
/// when the device cannot hold it.
std::vector<DepthMap> depths_beside(gpu::Context& context, const Part& part,
                                    std::span<const Camera> cameras);

/// What of a volume on the part's grid is its own; the rest is outside.
SparseVolume own_of(const Part& part, const SparseVolume& volume);
/// The triangles of a mesh whose middles lie in what is the part's own.
TriMesh own_of(const Part& part, TriMesh mesh);

/// Views that may show something of the part, without the pixels that do not. Throws Error where
/// fewer than two are left.
std::vector<PreparedView> views_of(const Part& part, std::vector<PreparedView> views);

}  // namespace photohull::pipeline
