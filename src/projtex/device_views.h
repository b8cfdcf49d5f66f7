// The views as kernels have them.
#pragma once

#include <cstddef>
#include <vector>

#include "gpu/buffer.h"
#include "shared/view.h"

namespace photohull::projtex {

/// Uniforms where they are few enough, which software devices fetch faster, else a storage block.
class DeviceViews {
 public:
  explicit DeviceViews(std::vector<shaders::GpuView> views);

  /// What programs that use them are compiled with.
  const char* defines() const { return defines_for(count_); }
  static const char* defines_for(std::size_t views);
  void bind() const;

 private:
  std::size_t count_;
  gpu::Buffer buffer_;
};

}  // namespace photohull::projtex
