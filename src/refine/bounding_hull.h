// The hull as what bounds a volume, without what is far from it; private to module refine.
#pragma once

#include <vector>

#include "core/grid.h"

namespace photohull::refine {

/// A level's hull, of which bricks far from a volume can be dropped: where no silhouettes bound
/// space the hull is the box, whose faces are larger than the surface in it.
class BoundingHull {
 public:
  explicit BoundingHull(SparseVolume hull) : hull_(std::move(hull)) {}

  /// Its grid is whole, whatever was dropped.
  const SparseVolume& volume() const { return hull_; }

  /// Drops stored bricks that lie beside no brick of `volume` that holds any of it. Both on one
  /// grid.
  void drop_far_from(const SparseVolume& volume);

  /// Is nothing missing that the intersection with `volume` asks for?
  bool bounds(const SparseVolume& volume) const;

 private:
  SparseVolume hull_;
  std::vector<bool> dropped_;  // by the table's index; empty: nothing was
};

}  // namespace photohull::refine
