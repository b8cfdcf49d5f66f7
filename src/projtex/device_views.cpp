#include "projtex/device_views.h"

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
    : count_(views.size()), buffer_(gpu::Buffer::of(padded(std::move(views)))) {}

const char* DeviceViews::defines_for(std::size_t views) {
  return views <= kMost ? "#define UNIFORM_VIEWS\n" : "";
}

void DeviceViews::bind() const {
  if (count_ <= kMost)
    buffer_.bind_uniform(shaders::kUniformViewsBinding);
  else
    buffer_.bind_storage(shaders::kViewsBinding);
}

}  // namespace photohull::projtex
