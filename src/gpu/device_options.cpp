#include "gpu/device_options.h"

namespace photohull::gpu {

Option& describe_device(Described& to, std::string& device) {
  return to.text("device", &device, "auto, software, or an index from 'photohull devices'");
}

Option& describe_threads(Described& to, int& threads) {
  Option& option = to.number("threads", &threads, at_least(0), "", "threads that compute");
  option.zero = "one a core";
  return option;
}

void describe(Described& to, DeviceOptions& o) {
  describe_device(to, o.device);
  describe_threads(to, o.threads);
}

}  // namespace photohull::gpu
