#include "gpu/context.h"

#include <malloc.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <thread>

#include "core/error.h"
#include "gpu/buffer_pool.h"
#include "gpu/egl_devices.h"
#include "gpu/gl.h"
#include "gpu/gl_error.h"
#include "gpu/program.h"
#include "gpu/texture.h"

namespace photohull::gpu {
namespace {

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Of all the process's threads.
std::int64_t cpu_ns() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return std::int64_t(now.tv_sec) * 1000000000 + now.tv_nsec;
}

/// Mesa's software rasterizer lets go of what a batch of triangles used when it uses the batch's
/// memory again, and takes for a new batch the first one that is done. It has 64 at most: as many
/// small ones take all of them while a large one, which many threads share, keeps them waiting.
/// What the device does not hold stays.
void renew_batches(const Limits& limits) {
  const int large = std::thread::hardware_concurrency() > 4 ? 2048 : 1024;
  if (limits.texture_size < large || limits.texture_layers < 64) return;
  try {
    TextureArray(TextureFormat::kSrgb8Alpha8, large, large, 1, 2).generate_mipmaps();
    TextureArray(TextureFormat::kSrgb8Alpha8, 2, 2, 64, 2).generate_mipmaps();
  } catch (const Error&) {  // there is no memory for what would set some free
  }
}

}  // namespace

struct Context::Egl : EglHandles {
  BufferPool pool;
};

std::unique_ptr<Context> Context::create(const std::string& device_selection, int threads) {
  if (threads > 0) setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  const std::vector<DeviceInfo> devices = list_devices();
  return std::make_unique<Context>(choose_device(devices, device_selection).index);
}

Context::Context(int egl_device_index) : egl_(std::make_unique<Egl>()) {
  const auto devices = query_egl_devices();
  PHOTOHULL_CHECK(egl_device_index >= 0 && egl_device_index < int(devices.size()));
  device_.index = egl_device_index;
  static_cast<EglHandles&>(*egl_) = make_context(devices[egl_device_index], device_);
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limits_.ssbo_bytes);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limits_.texture_size);
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limits_.texture_layers);
  for (unsigned axis = 0; axis < 3; ++axis) {
    GLint groups = 0;
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, axis, &groups);
    limits_.groups[axis] = groups;
  }
  try {
    if (const char* text = std::getenv(kLimitsVariable)) limits_ = lowered(limits_, text);
  } catch (...) {
    destroy_context(*egl_);
    throw;
  }
  set_current_limits(&limits_);
  set_current_traffic(&traffic_);
  set_current_pool(&egl_->pool);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

Context::~Context() {
  if (is_current(egl_->pool)) {
    empty_buffer_pool();
    set_current_pool(nullptr);
  }
  programs_.clear();
  set_current_limits(nullptr);
  set_current_traffic(nullptr);
  destroy_context(*egl_);
}

void Context::check_errors(const char* where) const {
  check_gl(concat(where, " on ", device_.renderer));
}

void Context::release_deleted() {
  constexpr unsigned kUnits = 8;
  for (unsigned unit = 0; unit < kUnits; ++unit) glBindTextureUnit(unit, 0);
  empty_buffer_pool();
  if (device_.software) renew_batches(limits_);
  Program::compute(*this, "gpu_nothing.comp.glsl")->dispatch(*this, "gpu_nothing", 1);
  malloc_trim(0);
}

Launch::Launch(Context& context, const char* name)
    : context_(context), name_(name), start_ns_(now_ns()), start_cpu_ns_(cpu_ns()) {
  glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
}

Launch::~Launch() {
  glFinish();
  glPopDebugGroup();
  LaunchStatistics& statistics = context_.statistics()[name_];
  ++statistics.launches;
  statistics.seconds += 1e-9 * double(now_ns() - start_ns_);
  statistics.cpu_seconds += 1e-9 * double(cpu_ns() - start_cpu_ns_);
}

}  // namespace photohull::gpu
