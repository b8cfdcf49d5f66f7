#include "pipeline/device_work.h"

namespace photohull::pipeline {

DeviceFindings device_work(gpu::Context& context) {
  const gpu::Traffic& traffic = context.traffic();
  DeviceFindings work{{}, traffic.uploads, traffic.bytes_up, traffic.downloads, traffic.bytes_down};
  for (const auto& [name, s] : context.statistics())
    work.kernels.push_back({name, s.launches, s.groups, s.seconds, s.cpu_seconds});
  return work;
}

}  // namespace photohull::pipeline
