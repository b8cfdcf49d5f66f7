// Choices of views as kernels have them; private to module refine.
#pragma once

#include <cstdint>
#include <span>

#include "gpu/buffer.h"
#include "refine/view_choice.h"
#include "shared/refine.h"

namespace photohull::refine {

/// What surfels are matched in.
gpu::Buffer to_device(std::span<const ViewChoice> choices);
/// Those of the surfels at `indices`.
gpu::Buffer to_device(std::span<const ViewChoice> choices, std::span<const std::uint32_t> indices);

ViewChoice from_device(const shaders::MatchChoice& choice);

}  // namespace photohull::refine
