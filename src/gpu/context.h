// A surfaceless OpenGL 4.5 context, current on the thread that made it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "gpu/device.h"
#include "gpu/limits.h"
#include "gpu/traffic.h"

namespace photohull::gpu {

class Program;

/// Time spent in the launches of one name.
struct LaunchStatistics {
  std::int64_t launches = 0;
  std::int64_t groups = 0;  ///< work groups of kernels, in all
  double seconds = 0;       ///< by the clock
  double cpu_seconds = 0;   ///< of all the process's threads; what software devices cost
};

class Context {
 public:
  /// `threads` bounds the software rasterizer's worker threads (0: one a core); it must be set
  /// before the first context of the process. Throws Error when the device gives no 4.5 context.
  static std::unique_ptr<Context> create(const std::string& device_selection, int threads = 0);
  /// A context on one EGL device. Throws UsageError when kLimitsVariable cannot be read.
  explicit Context(int egl_device_index);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const DeviceInfo& device() const { return device_; }
  /// The device's, or lower ones that kLimitsVariable gives.
  const Limits& limits() const { return limits_; }
  /// Throws Error naming `where` if GL has an error pending (out of memory, lost context).
  void check_errors(const char* where) const;

  /// Makes the driver let go of deleted textures and buffers that earlier dispatches used, and
  /// gives the memory back to the system. Worth a call after a stage that held much.
  void release_deleted();

  /// Seconds and count per launch name since the start; kernels add to it through `Launch`.
  std::map<std::string, LaunchStatistics>& statistics() { return statistics_; }
  const Traffic& traffic() const { return traffic_; }
  /// Programs that live as long as the context; Program::compute and raster fill it.
  std::map<std::string, std::shared_ptr<const Program>>& programs() { return programs_; }

 private:
  struct Egl;
  std::unique_ptr<Egl> egl_;
  DeviceInfo device_;
  Limits limits_;
  std::map<std::string, LaunchStatistics> statistics_;
  Traffic traffic_;
  std::map<std::string, std::shared_ptr<const Program>> programs_;
};

/// Scope of a named launch: a GL debug group, and wall time up to the end of the work on the
/// device.
class Launch {
 public:
  Launch(Context& context, const char* name);
  ~Launch();
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;

 private:
  Context& context_;
  const char* name_;
  std::int64_t start_ns_, start_cpu_ns_;
};

}  // namespace photohull::gpu
