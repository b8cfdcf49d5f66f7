// Masks that come with the photographs, and checks on all masks.
#pragma once

#include <vector>

#include "core/prepared_views.h"
#include "core/scene.h"
#include "core/view_loader.h"

namespace photohull {

enum class MaskOrigin { kNone, kFile, kAlpha, kPlate, kBackground };

/// Fills view.mask from the file that the scene names, else from an alpha channel that varies, in
/// pixels of `view.image`; a file that is a scaled copy (core/scaled_size.h) is resampled to them.
/// `from_ones`: FileMask's, of a file. Throws Error for a mask of another size and what the loader
/// throws.
MaskOrigin take_given_mask(const SourceView& source, const ViewLoader& loader, PreparedView& view,
                           bool& from_ones);

/// Sets the alpha of an image that has such a channel to 1: from here on it tells what is known.
void make_opaque(ColourImage& image);

/// Sets mask_source, the masks' sources, the confidence of those that were given, and
/// mask_confidence from where each view's mask came.
void describe_masks(const std::vector<MaskOrigin>& origins, PreparedViews& views);

/// Checks masks that were given. Warns of views whose mask is all background or all foreground.
/// Throws Error when all masks are empty, or when most show foreground along the frame and
/// background in the middle.
void check_masks(PreparedViews& views);

}  // namespace photohull
