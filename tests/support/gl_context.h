// The GL context that all tests of a program share.
#pragma once

#include "gpu/context.h"

namespace photohull::test {

/// Current on the calling thread; made at the first call on the device that "auto" means.
gpu::Context& gl_context();

}  // namespace photohull::test
