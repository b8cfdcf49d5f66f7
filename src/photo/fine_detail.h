// How much fine detail a photograph has.
#pragma once

#include "photo/align_patch.h"

namespace photohull {

/// Root of the gradients' energy at the scale of pixels (a Gaussian of 0.7) relative to that at
/// four times that scale, so that contrast falls out: less where the photograph is blurred. To be
/// compared between photographs of the same, of the same size. 0 where there is no texture.
double fine_detail(const GreyImage& grey);

}  // namespace photohull
