// EGL device enumeration. Extensions: EGL_EXT_device_enumeration, EGL_EXT_platform_device,
// EGL_KHR_surfaceless_context, EGL_MESA_device_software.
#include "gpu/device.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "core/error.h"
#include "core/option_word.h"
#include "core/process_limits.h"
#include "gpu/debug_messages.h"
#include "gpu/egl_devices.h"
#include "gpu/gl.h"

namespace photohull::gpu {
namespace {

template <typename F>
F egl_function(const char* name) {
  const auto f = reinterpret_cast<F>(eglGetProcAddress(name));
  if (!f) throw Error(concat("EGL lacks ", name, "; install libegl1 and libgl1-mesa-dri"));
  return f;
}

const char* text_of(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

bool is_software_renderer(const std::string& renderer) {
  return renderer.find("llvmpipe") != std::string::npos ||
         renderer.find("softpipe") != std::string::npos ||
         renderer.find("swrast") != std::string::npos;
}

}  // namespace

std::vector<EGLDeviceEXT> query_egl_devices() {
  const char* threads = std::getenv("LP_NUM_THREADS");  // of Mesa's software rasterizer
  check_process_limits(threads ? std::atoi(threads) : 0);
  const auto query = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  EGLint count = 0;
  if (!query(0, nullptr, &count) || count <= 0)
    throw Error("EGL reports no device; install libgl1-mesa-dri for the software rasterizer");
  std::vector<EGLDeviceEXT> devices(count);
  query(count, devices.data(), &count);
  devices.resize(count);
  return devices;
}

EglHandles make_context(EGLDeviceEXT device, DeviceInfo& info) {
  const auto get_display =
      egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  EglHandles handles;
  handles.display = get_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  if (handles.display == EGL_NO_DISPLAY || !eglInitialize(handles.display, nullptr, nullptr))
    throw Error("its EGL display cannot be initialised (no permission, or no driver)");
  eglBindAPI(EGL_OPENGL_API);
  const EGLint config_attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                      EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  eglChooseConfig(handles.display, config_attributes, &config, 1, &configs);
  EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                         4,
                         EGL_CONTEXT_MINOR_VERSION,
                         5,
                         EGL_CONTEXT_OPENGL_DEBUG,
                         debug_is_asked_for() ? EGL_TRUE : EGL_FALSE,
                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                         EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                         EGL_LOSE_CONTEXT_ON_RESET,
                         EGL_NONE};
  const EGLConfig chosen = configs > 0 ? config : EGL_NO_CONFIG_KHR;
  handles.context = eglCreateContext(handles.display, chosen, EGL_NO_CONTEXT, attributes);
  if (handles.context == EGL_NO_CONTEXT) {  // perhaps it cannot tell of resets
    std::copy(std::end(attributes) - 1, std::end(attributes), std::end(attributes) - 3);
    handles.context = eglCreateContext(handles.display, chosen, EGL_NO_CONTEXT, attributes);
  }
  if (handles.context == EGL_NO_CONTEXT) throw Error("it gives no OpenGL 4.5 core context");
  if (!eglMakeCurrent(handles.display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles.context)) {
    eglDestroyContext(handles.display, handles.context);
    throw Error("its context cannot be made current without a surface");
  }
  if (debug_is_asked_for()) print_debug_messages();
  info.renderer = text_of(GL_RENDERER);
  info.vendor = text_of(GL_VENDOR);
  info.version = text_of(GL_VERSION);
  info.software = is_software_renderer(info.renderer);
  return handles;
}

void destroy_context(const EglHandles& handles) {
  if (handles.context == EGL_NO_CONTEXT) return;
  eglMakeCurrent(handles.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(handles.display, handles.context);
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> infos;
  for (const EGLDeviceEXT device : query_egl_devices()) {
    DeviceInfo info;
    info.index = int(infos.size());
    try {
      destroy_context(make_context(device, info));
    } catch (const Error& e) {
      info.problem = e.what();
    }
    infos.push_back(info);
  }
  return infos;
}

DeviceInfo choose_device(const std::vector<DeviceInfo>& devices, const std::string& selection) {
  if (selection != "auto" && selection != "software") {
    int index = -1;
    const char* end = selection.data() + selection.size();
    const auto parsed = std::from_chars(selection.data(), end, index);
    if (parsed.ec != std::errc() || parsed.ptr != end)
      throw UsageError(concat(option_word("device"),
                              ": expected auto, software or an index, found '", selection, "'"));
    for (const DeviceInfo& d : devices) {
      if (d.index != index) continue;
      if (!d.problem.empty()) throw Error(concat(option_word("device", index), ": ", d.problem));
      return d;
    }
    throw UsageError(concat(option_word("device", index), ": there are devices 0 to ",
                            devices.size() - 1, "; see 'photohull devices'"));
  }
  for (const bool software : {false, true}) {
    if (selection == "software" && !software) continue;
    for (const DeviceInfo& d : devices)
      if (d.problem.empty() && d.software == software) return d;
  }
  throw Error(selection == "software"
                  ? "no software rasterizer: install libgl1-mesa-dri"
                  : "no EGL device gives an OpenGL 4.5 context: install libgl1-mesa-dri");
}

}  // namespace photohull::gpu
