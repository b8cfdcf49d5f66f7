// Decisions of a sweep as its last kernel leaves them (carving_update_columns.comp.glsl).
#pragma once

#include <cstdint>
#include <vector>

#include "carving/decisions.h"
#include "gpu/buffer.h"

namespace photohull::carving {

/// Appends those on a list of kSweepDecisionsBinding. Returns how many voxels were judged.
std::uint32_t read_decisions(const gpu::Buffer& list, std::vector<Decision>& out);

}  // namespace photohull::carving
