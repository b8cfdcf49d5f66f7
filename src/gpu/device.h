// EGL devices and the choice between them.
#pragma once

#include <string>
#include <vector>

namespace photohull::gpu {

struct DeviceInfo {
  int index = 0;          ///< position in EGL's enumeration, what --device INDEX means
  std::string renderer;   ///< GL_RENDERER, empty where no context could be made
  std::string vendor;     ///< GL_VENDOR
  std::string version;    ///< GL_VERSION
  bool software = false;  ///< Mesa's software rasterizer
  std::string problem;    ///< why the device cannot be used; empty when it can
};

/// All EGL devices, each tried with an OpenGL 4.5 core context. Throws Error when EGL is missing.
std::vector<DeviceInfo> list_devices();

/// Which of `devices` a --device argument means: "auto" takes the first usable hardware device,
/// else the software rasterizer; "software" that one; a number the device of that index. Throws
/// UsageError for other text or an index that does not exist, Error when none is usable.
DeviceInfo choose_device(const std::vector<DeviceInfo>& devices, const std::string& selection);

}  // namespace photohull::gpu
