// Where the photographs are taken from.
#pragma once

#include <vector>

#include "synth/lens.h"
#include "synth/surface.h"

namespace photohull::synth {

/// The cameras of a spec around a surface, looking at the middle of its box, upright along z.
/// Azimuth 0 looks along +y; turns go counter-clockwise seen from above. The focal length (square
/// pixels) is such that the surface fills `fill` of the frame's width or height in the view where
/// it is largest; of a surface that moves, the box around all frames does. Throws Error naming the
/// view when a camera is inside the object or so near that a part of it is behind the camera, and
/// when the lens folds over within the frame.
std::vector<LensCamera> place_cameras(const Spec& spec, const Surface& surface);

}  // namespace photohull::synth
