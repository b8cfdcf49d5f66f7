// Parts of the visual hull that lie between the centres of voxels.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "carving/hull.h"
#include "core/box.h"
#include "core/camera.h"
#include "core/grid.h"

namespace photohull::carving {

/// Makes voxels inside that hold a part of the hull which the distances at voxel centres say
/// nothing of: stems and sheets thinner than a voxel. Within such a voxel the point deepest in all
/// silhouettes is looked for; where it lies in the hull and the interpolated volume does not have
/// it, the voxel takes its distance. `volume` is the hull of the same silhouettes. Returns the
/// number of voxels that changed.
std::size_t keep_thin_parts(SparseVolume& volume, const Box& box, std::span<const Camera> cameras,
                            std::span<const Silhouette> silhouettes, const HullOptions& options);

/// Which of the lattice's voxels fall beside lines in a third of the views that see them, and in
/// three at least: stems, and sheets seen on edge.
std::vector<bool> on_stems(const GridSpec& grid, std::span<const Camera> cameras,
                           std::span<const Silhouette> silhouettes,
                           std::span<const glm::ivec3> voxels);

}  // namespace photohull::carving
