// Maps of triangles instead of depths. Private to visibility.
#pragma once

#include "visibility/kernels/visibility_map.h"

namespace photohull::visibility {

/// Fills a map of Detail other than kNone, whose layout is done.
void draw_detail(gpu::Context& context, const Geometry& geometry, VisibilityMap& map);

}  // namespace photohull::visibility
