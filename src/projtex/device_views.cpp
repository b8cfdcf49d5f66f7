#include "projtex/device_views.h"

#include <cstddef>
#include <utility>

namespace photohull::projtex {
namespace {

constexpr std::size_t kMost = shaders::kMostUniformViews;

/// A uniform block is as large as the shader says, however many views it holds.
std::vector<shaders::GpuView> padded(std::vector<shaders::GpuView> views) {
  if (views.size() < kMost) views.resize(kMost);
  return views;
}

}  // namespace

DeviceViews::DeviceViews(std::vector<shaders::GpuView> views)
    : is_uniform_(views.size() <= kMost), buffer_(gpu::Buffer::of(padded(std::move(views)))) {}

const char* DeviceViews::defines() const { return is_uniform_ ? "#define UNIFORM_VIEWS\n" : ""; }

void DeviceViews::bind() const {
  if (is_uniform_)
    buffer_.bind_uniform(shaders::kUniformViewsBinding);
  else
    buffer_.bind_storage(shaders::kViewsBinding);
}

}  // namespace photohull::projtex
