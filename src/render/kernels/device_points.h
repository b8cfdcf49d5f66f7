// Points of a surface as kernels take them.
#pragma once

#include <span>

#include "gpu/buffer.h"
#include "render/surface_points.h"

namespace photohull::render {

/// Their shaders::SurfacePoints.
gpu::Buffer to_device(std::span<const SurfacePoint> points);

}  // namespace photohull::render
