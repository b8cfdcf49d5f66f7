// From the outcomes of a sweep, column by column, to what is carved.
#pragma once

#include <span>
#include <vector>

#include "carving/bit_volume.h"

namespace photohull::carving {

/// What became of a voxel that a sweep found bare.
enum class Outcome {
  kKept,       ///< consistent where it is bare
  kBetter,     ///< inconsistent, and a layer behind is clearly better
  kUndecided,  ///< inconsistent, but nothing behind is better
  kUnseen      ///< too few cameras or too little texture to say anything
};

/// Of a column of voxels along a sweep.
struct Decision {
  glm::ivec2 column{0};  ///< in the plane across the sweep
  int bare = 0;          ///< layer of the bare voxel
  int surface = 0;       ///< layer of the surface
  float score = 0;       ///< at the bare voxel
  float best_score = 0;
  Outcome outcome = Outcome::kUnseen;

  bool operator==(const Decision&) const = default;
};

/// Carves the columns whose outcome their neighbours in the plane support, and columns that an
/// outcome of their neighbours' explains: a surface is continuous, chance agreement is not. `axis`
/// and `sign` are the sweep's. Returns the carved voxels; the result does not depend on the
/// decisions' order.
std::vector<glm::ivec3> apply_decisions(BitVolume& bits, int axis, int sign,
                                        std::span<const Decision> decisions);

}  // namespace photohull::carving
