// Hollows that the photographs do not prove.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/describe.h"
#include "core/grid.h"

namespace photohull::refine {

struct UnprovenOptions {
  double least_weight = 0.12;
};

inline void describe(Described& to, UnprovenOptions& o) {
  to.number("least_weight", &o.least_weight, from_to(0, 1), "",
            "mean weight of the peaks that a hollow's surface must have; 0: none");
}

/// Fills the hollows of the volume under its hull whose surface no photograph tells of: where
/// matches are weak, false ones dig pits, and the hull, which no photograph contradicts there, is
/// the better guess. A hollow is a connected part of the space under the hull that the volume
/// leaves empty; its surface are the vertices (`positions`, voxels, with outward `normals`) that
/// look into it, and `weights` those of their peaks, below 0 where no view sees the vertex: a
/// hollow that is mostly unseen is none of this function's business. All on the hull's grid.
/// Returns the number of voxels filled.
std::size_t fill_unproven(const SparseVolume& hull, std::span<const glm::vec3> positions,
                          std::span<const glm::vec3> normals, std::span<const float> weights,
                          const UnprovenOptions& options, SparseVolume& volume);

}  // namespace photohull::refine
