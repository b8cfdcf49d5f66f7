// Masks as segmentation gets them wrong.
#pragma once

#include "core/image.h"
#include "synth/render.h"

namespace photohull::synth {

/// The exact mask: coverage at 8 bits.
Mask exact_mask(const Picture& picture);

/// Grows (or, negative, shrinks) the mask by mask_grow pixels and tears mask_holes round holes of
/// mask_hole_radius into it, each centred on its foreground.
Mask degrade_mask(const Mask& mask, const DegradationSpec& spec, std::uint64_t seed,
                  std::size_t view);

}  // namespace photohull::synth
