// What a mesh hides from the cameras (render_splat_points.comp.glsl).
#pragma once

#include <span>

#include "core/grid.h"
#include "core/mesh.h"
#include "gpu/context.h"
#include "projtex/device_views.h"
#include "projtex/photographs.h"
#include "render/surface_points.h"
#include "visibility/kernels/depth_maps.h"

namespace photohull::render {

/// Depth maps (occluder_maps) of a mesh whose vertices are `vertices` (to_voxels), and of what is
/// beside it, drawn as points that are close enough to leave no gaps. `views` are the cameras'.
/// Throws Error when the device cannot hold the data.
visibility::DepthMaps draw_occluders(gpu::Context& context, const GridSpec& grid,
                                     const projtex::Photographs& photographs,
                                     const projtex::DeviceViews& views, const TriMesh& mesh,
                                     std::span<const SurfacePoint> vertices);

}  // namespace photohull::render
