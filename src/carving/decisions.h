// From the outcomes of a sweep, column by column, to what is carved.
#pragma once

#include <span>
#include <vector>

#include "carving/bit_volume.h"
#include "shared/sweep.h"

namespace photohull::carving {

/// Carves the columns whose outcome their neighbours in the plane support, and columns that an
/// outcome of their neighbours' explains: a surface is continuous, chance agreement is not. `axis`
/// and `sign` are the sweep's. Returns the carved voxels; the result does not depend on the
/// decisions' order.
std::vector<glm::ivec3> apply_decisions(BitVolume& bits, int axis, int sign,
                                        std::span<const shaders::Decision> decisions);

}  // namespace photohull::carving
