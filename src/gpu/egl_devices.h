// Private to module gpu: raw EGL handles.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>
#include <vector>

#include "gpu/device.h"

namespace photohull::gpu {

struct EglHandles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

/// Every EGL device of the machine. Throws Error when EGL cannot enumerate devices, and where the
/// system's limits leave too little memory for drivers.
std::vector<EGLDeviceEXT> query_egl_devices();

/// Makes a 4.5 core context current; fills renderer, vendor, version, software. Throws Error.
EglHandles make_context(EGLDeviceEXT device, DeviceInfo& info);
void destroy_context(const EglHandles& handles);

}  // namespace photohull::gpu
