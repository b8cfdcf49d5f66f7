// What moves over the frames of a sequence. Internal to synth.
#pragma once

#include <optional>

#include "core/progress.h"
#include "synth/surface.h"

namespace photohull::synth {

/// Does the surface differ between the frames of the spec's sequence?
bool moves(const Spec& spec);

/// The geometry of a frame of the spec's sequence.
GeometrySpec geometry_of_frame(const Spec& spec, int frame);

/// Around the surfaces of all frames; nothing where it does not move. A stage of its own.
std::optional<Box> box_of_frames(const Spec& spec, Progress& progress);
/// That stage's weight.
double box_weight(const Spec& spec);

/// The surface of the spec's moment. With the box of all frames its box and diagonal are theirs, so
/// that cameras, lights, box and the scale of patterns are the same in all; the pattern goes with
/// what rotates and translates.
Surface surface_at_moment(const Spec& spec, const std::optional<Box>& all);

}  // namespace photohull::synth
