// Time of work on the device. Private to lab.
#pragma once

#include <chrono>
#include <ctime>

#include "gpu/context.h"

namespace photohull::projtex {

/// Seconds that `work` takes: of all the process's threads on software devices, which other
/// programs disturb less, and by the clock on others. `work` must wait for the device.
template <typename Work>
double seconds_of(const gpu::Context& context, const Work& work) {
  if (context.device().software) {
    timespec before{}, after{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
    work();
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
    return double(after.tv_sec - before.tv_sec) + 1e-9 * double(after.tv_nsec - before.tv_nsec);
  }
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace photohull::projtex
