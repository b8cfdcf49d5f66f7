// Which device computes, and how many threads.
#pragma once

#include <string>

#include "core/describe.h"

namespace photohull::gpu {

/// Of commands that need no more than a context.
struct DeviceOptions {
  std::string device = "auto";
  int threads = 0;  ///< 0: one a core
};

Option& describe_device(Described& to, std::string& device);
Option& describe_threads(Described& to, int& threads);
void describe(Described& to, DeviceOptions& options);

}  // namespace photohull::gpu
