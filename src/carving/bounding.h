// Do silhouettes tell where an object is?
#pragma once

#include <span>

#include "carving/hull.h"
#include "core/box.h"
#include "core/grid.h"

namespace photohull::carving {

/// Whether silhouettes bound what they show, so that what no photograph tells of under the hull may
/// be taken for solid: half of the views or more have one, and less than half of the hull's surface
/// is where the box cuts it off. Masks of a few views do not, nor do masks that leave out the sky
/// alone. `hull` is theirs within `box`; a coarse grid is enough.
bool silhouettes_bound(const SparseVolume& hull, const Box& box,
                       std::span<const Silhouette> silhouettes);

/// Share of the faces between the volume's voxels and those beside that lie at the box's sides; 1
/// where it has no faces.
double share_at_box(const SparseVolume& volume, const Box& box);

}  // namespace photohull::carving
