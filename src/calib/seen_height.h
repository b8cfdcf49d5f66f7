// How high above a sheet photographs can show anything.
#pragma once

#include <span>

#include "core/box.h"
#include "core/camera.h"

namespace photohull {

/// The box, lower where its upper part is above the photographs' upper edges: its middle axis ends
/// where three cameras have it on their image (or all, where there are fewer). What no photograph
/// shows would stay in a model as debris. As given where that says nothing: its foot is not seen.
Box lowered_to_seen(const Box& box, std::span<const Camera> cameras);

}  // namespace photohull
