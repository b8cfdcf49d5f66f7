// How sharp photographs are beside others of the same.
#pragma once

#include <span>
#include <vector>

#include "core/box.h"
#include "core/prepared_view.h"

namespace photohull {

/// How much fine detail a view has for its coarse detail, as amplitudes, in the direction in which
/// it lacks most, beside the median of views near it: about 1 as sharp as they are, less blurred.
/// Coarse detail is lost in long movements too, so that it falls slowly: to 0.7 for 8 pixels.
///
/// Of each view: the least eigenvalue of the structure tensor of the image at the scale of its
/// pixels (a Gaussian of 0.7), less what noise adds, relative to that of the image at four times
/// that scale, so that contrast and the texture's direction fall out. Pixels that masks leave out
/// do not count. Then its root relative to that of up to eight views, nearest in direction as seen
/// from the box's middle, whose pixels are up to 1.5 times as large or small there. Views with
/// fewer than three such neighbours, or without texture, have 1; neighbours in which noise is more
/// of the fine detail than the image are none.
///
/// `noise_sigma` as estimate_image_noise gives it. In parallel; the same for any number of threads.
std::vector<double> relative_sharpness(std::span<const PreparedView> views, const Box& box,
                                       double noise_sigma);

}  // namespace photohull
