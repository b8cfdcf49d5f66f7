// What a run asked of the graphics device.
#pragma once

#include "gpu/context.h"
#include "pipeline/findings.h"

namespace photohull::pipeline {

/// The work that the context has counted since it was made.
DeviceFindings device_work(gpu::Context& context);

}  // namespace photohull::pipeline
