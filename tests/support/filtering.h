// How exactly the device filters textures.
#pragma once

namespace photohull::test {

/// The worst error of linear filtering between a texel of 0 and one of 1, measured on the tests'
/// device. OpenGL leaves the precision of the weights open: llvmpipe computes them in floating
/// point, hardware rounds them to 8 bits or so, and tests that compare with exact weights allow for
/// it.
double filtering_error();

}  // namespace photohull::test
