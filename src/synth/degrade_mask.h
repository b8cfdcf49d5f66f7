// Masks as segmentation gets them wrong.
#pragma once

#include "core/image.h"
#include "synth/render.h"

namespace photohull::synth {

/// The exact mask: coverage at 8 bits.
Mask exact_mask(const Picture& picture);

/// The mask that looks at the pixels' centres alone: 255 where the object covers it, else 0.
Mask centre_mask(const Picture& picture);

/// The mask that a scene starts from: that of the centres for "aliased", else the exact one.
Mask undegraded_mask(const Picture& picture, const DegradationSpec& spec);

/// Grows (or, negative, shrinks) the mask by mask_grow pixels; for "cut" and "eroded" makes it 255
/// where the coverage is at least mask_cut and 0 elsewhere; for "eroded" takes the pixels that have
/// a neighbour to the left, right, above or below within the frame that is 0; then tears mask_holes
/// round holes of mask_hole_radius into it, each centred on its foreground. Their edges are soft in
/// masks of coverage, hard in all others.
Mask degrade_mask(const Mask& mask, const DegradationSpec& spec, std::uint64_t seed,
                  std::size_t view);

}  // namespace photohull::synth
