// Which views a group of neighbouring vertices needs to look at.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/surface_points.h"
#include "shared/surface_points.h"
#include "shared/view.h"

namespace photohull::render {

/// For each run of kListedPoints vertices, 1 + views.size() words: a count, then the indices of the
/// views that at least one of its vertices may face with a cosine above `least_cosine`. Bounds a
/// group by a sphere and a cone of normals [Shirman93], so that it may list too many, never too
/// few.
std::vector<std::uint32_t> list_views(std::span<const SurfacePoint> vertices,
                                      std::span<const shaders::GpuView> views, float least_cosine);

/// How many vertices, in whole groups, a dispatch may take that has their lists and `vertex_bytes`
/// for each in storage blocks: at most `most` (gpu::batch_size).
std::size_t listed_batch(std::size_t vertex_bytes, std::size_t most, std::size_t views);

}  // namespace photohull::render
