// Where photographs on a sheet can show the object, from what all of their masks say together.
#pragma once

#include <span>
#include <vector>

#include "calib/pose_photographs.h"
#include "core/image.h"

namespace photohull {

/// Shadows of a coarse visual hull [Laurentini94]: of each photograph with a mask a mask of the
/// same size, 255 where it can show the object and 0 elsewhere; empty for the others. The hull is
/// of the cells of a lattice over the box, 96 along the longest side. A cell is left out where two
/// masks or more (one, of fewer than three) have nothing within its picture: what one mask misses
/// is not taken from the others. Shadows are rather too large, by the size of a cell.
/// `masks`: one for each photograph, of the photographs' size or scaled copies of it; empty where
/// there is none, as for those that are not posed.
std::vector<Mask> shadows_of_hull(const PoseResult& result, std::span<const Mask> masks);

}  // namespace photohull
