// From box and images to a voxel lattice.
#pragma once

#include <cstdint>
#include <span>

#include "core/box.h"
#include "core/camera.h"
#include "core/grid.h"

namespace photohull::carving {

/// World size of a pixel's footprint at the box's centre (core/viewing_depth.h, for views within),
/// the median over the views that have that in front of them: depth / focal length. 0 when no view
/// has.
double pixel_footprint(const Box& box, std::span<const Camera> cameras);

/// Can one lattice have so many bricks along each axis, by the memory that its index takes?
bool is_lattice(const glm::dvec3& bricks);

/// A lattice over the box, grown by a margin of `kMargin` voxels on each side. Throws UsageError
/// for a voxel size that is not finite and positive, and TooManyVoxels where that is no lattice.
GridSpec fit_grid(const Box& box, double voxel_size);

/// A lattice whose voxels tile the box from its lower corner: voxel (3, 3, 3) begins there, and the
/// margin is at least as wide at the other end. Boxes that share that corner, or whose corners are
/// whole voxels apart, have voxels in common. Throws as fit_grid does.
GridSpec fixed_grid(const Box& box, double voxel_size);

/// Voxel size for an effective resolution of `resolution`^3: the box's longest side has that many.
double voxel_size_for(const Box& box, int resolution);

/// The grid with voxels twice as large over the same space.
GridSpec coarser(const GridSpec& grid);

}  // namespace photohull::carving
