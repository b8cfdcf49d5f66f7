// The part of a box that silhouettes leave to the object.
#pragma once

#include <span>

#include "core/box.h"
#include "core/prepared_view.h"

namespace photohull::carving {

/// Is the box much larger than what the masks show: does a camera stand inside it, or do the masks'
/// foregrounds fill less than 0.55 of its width and height in half of the views with masks?
bool box_is_oversized(const Box& box, std::span<const PreparedView> views);

/// The bounds, with a margin of a cell, of the cells of a lattice (48 along the longest side) that
/// no silhouette rejects and that at least half as many views (and two) have on their images as the
/// best-seen one of them; then the same within these bounds, until they stay. The box as given
/// where nothing is left of it, or where fewer than two views have masks.
Box object_box(const Box& box, std::span<const PreparedView> views);

}  // namespace photohull::carving
