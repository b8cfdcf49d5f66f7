// Views cut down to what the region of interest needs.
#pragma once

#include "core/box.h"
#include "core/prepared_view.h"

namespace photohull {

/// Crops a view's image, mask and silhouette to the rectangle that the box (world) projects to,
/// grown by `margin` pixels on each side, and moves the principal point accordingly: everything
/// after works on fewer pixels, with the same result. A view that has part of the box behind it, or
/// none of it on its image, stays as it is. The rectangle begins at multiples of `multiple` pixels:
/// where that is a power of two, texels of as many mip levels cover what they cover of the whole
/// image.
void crop_to_box(const Box& box, int margin, PreparedView& view, int multiple = 1);

/// The intrinsics that this gives a view of the camera.
Intrinsics cropped_intrinsics(const Box& box, int margin, const Camera& camera, int multiple = 1);

}  // namespace photohull
