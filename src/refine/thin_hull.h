// Parts of the hull that are thinner than patches can judge.
#pragma once

#include <cstddef>
#include <span>

#include "carving/hull.h"
#include "core/camera.h"
#include "core/grid.h"

namespace photohull::refine {

struct ThinHullOptions {
  double depth =
      1.25;            ///< voxels below the hull's surface that such a part does not reach; 0: none
  double reach = 1.5;  ///< voxels from the volume's surface within which it is kept
};

/// Closes tears of the volume in sheets and stems of the hull: where the hull is thin and the
/// volume has nothing left across it, the hull comes back. Patches there mix in what lies behind,
/// and steps of the distance wear thin parts away. Only beside what the volume has, so that thin
/// parts of the hull that photographs freed stay free. Both on one grid. Returns the number of
/// voxels that came back.
std::size_t keep_thin_hull(const SparseVolume& hull, const ThinHullOptions& options,
                           SparseVolume& volume);

/// Joins parts of the volume that the hull joins by stems which silhouettes show as lines: where it
/// is thin, by the fewest of its voxels (carving/join_parts.h). Both on one grid. Returns the
/// number of voxels that came back.
std::size_t rejoin_stems(const SparseVolume& hull, std::span<const Camera> cameras,
                         std::span<const carving::Silhouette> silhouettes,
                         const ThinHullOptions& options, SparseVolume& volume);

}  // namespace photohull::refine
