// Parts of the hull that are thinner than patches can judge.
#pragma once

#include <cstddef>
#include <span>

#include "carving/hull.h"
#include "core/camera.h"
#include "core/describe.h"
#include "core/grid.h"

namespace photohull::refine {

struct ThinHullOptions {
  double depth = 1.25, reach = 1.5;
};

inline void describe(Described& to, ThinHullOptions& o) {
  to.number("depth", &o.depth, from_to(0, SparseVolume::kBand), "voxels",
            "depth below the hull's surface that a thin part does not reach; 0: no part is thin");
  to.number("reach", &o.reach, from_to(0, SparseVolume::kBand), "voxels",
            "distance from the volume's surface within which a thin part is kept");
}

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
