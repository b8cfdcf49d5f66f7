#include "visibility/kernels/visibility_map.h"

#include <algorithm>

namespace photohull::visibility {
namespace {

constexpr std::size_t kSamples = std::size_t(1) << 20;  // on the device at once

std::size_t texel_bytes(const gpu::TextureArray& texture, std::size_t each) {
  return texture.id() ? std::size_t(texture.width()) * texture.height() * texture.layers() * each
                      : 0;
}

}  // namespace

std::size_t VisibilityMap::bytes() const {
  return texel_bytes(first_, 4) + texel_bytes(second_, 4) + texel_bytes(ids_, 4) +
         texel_bytes(moments_, 8) + triangles_.bytes() + list_ends_.bytes() + list_.bytes() +
         list_rest_.bytes();
}

std::vector<float> VisibilityMap::depths(bool second) const {
  const gpu::TextureArray& texture = second ? second_ : first_;
  std::vector<float> out(texel_bytes(texture, 1));
  if (!out.empty()) texture.read(0, out.size() * 4, out.data());
  return out;
}

std::vector<std::uint32_t> VisibilityMap::ids() const {
  std::vector<std::uint32_t> out(texel_bytes(ids_, 1));
  if (!out.empty()) ids_.read(0, out.size() * 4, out.data());
  return out;
}

std::vector<std::uint32_t> VisibilityMap::triangles_at(gpu::Context& context, int part,
                                                       const glm::ivec2& texel) const {
  const std::size_t at = (std::size_t(part) * layout_.size.y + texel.y) * layout_.size.x + texel.x;
  std::vector<std::uint32_t> out;
  if (technique_.detail == Detail::kLists) {
    const auto ends = list_ends_.download<std::uint32_t>(2, at);
    const std::uint32_t block = technique_.list_block;
    const auto append = [&](const gpu::Buffer& words, std::uint32_t first, std::uint32_t end) {
      if (first >= end) return;
      const auto ids = words.download<std::uint32_t>(end - first, first);
      out.insert(out.end(), ids.begin(), ids.end());
    };
    append(list_, ends[0], std::min(ends[1], block));
    append(list_rest_, std::max(ends[0], block) - block, std::max(ends[1], block) - block);
  } else if (technique_.detail == Detail::kCoverage) {
    const gpu::Buffer links(sizeof(glm::uvec4));
    bind();
    links.bind_storage(shaders::kLinksBinding);
    const auto program = gpu::Program::compute(context, "visibility_link_triangles.comp.glsl");
    program->set("texel", glm::ivec3(texel, part));
    program->dispatch(context, "visibility_link_triangles", 1);
    out = links.download<std::uint32_t>(shaders::kMaxLinks);
  } else if (technique_.detail == Detail::kSubPixel) {
    out = list_ends_.download<std::uint32_t>(1, at);
  }
  std::erase(out, shaders::kNoTriangle);
  std::sort(out.begin(), out.end());
  return out;
}

void VisibilityMap::bind() const {
  info_.bind_uniform(shaders::kMapInfoBinding);
  if (first_.id()) first_.bind(shaders::kFirstDepthUnit);
  if (second_.id()) second_.bind(shaders::kSecondDepthUnit);
  if (ids_.id()) ids_.bind(shaders::kNearestIdsUnit);
  if (moments_.id()) moments_.bind(shaders::kDepthMomentsUnit);
  if (triangles_.id()) triangles_.bind_storage(shaders::kMapTrianglesBinding);
  if (list_ends_.id()) list_ends_.bind_storage(shaders::kMapListEndsBinding);
  if (list_.id()) list_.bind_storage(shaders::kMapListBinding);
  if (list_rest_.id()) list_rest_.bind_storage(shaders::kMapListRestBinding);
}

std::vector<float> visible(gpu::Context& context, const VisibilityMap& map,
                           std::span<const Sample> samples) {
  const std::size_t batch = gpu::batch_size(sizeof(shaders::Receiver), kSamples);
  std::vector<float> out;
  out.reserve(samples.size());
  map.bind();
  for (std::size_t first = 0; first < samples.size(); first += batch) {
    std::vector<shaders::Receiver> receivers;
    for (const Sample& s : samples.subspan(first, std::min(batch, samples.size() - first)))
      receivers.push_back({glm::vec4(s.position - map.origin_, 1),
                           glm::vec4(s.normal, 0),
                           glm::vec4(s.step_x, 0),
                           glm::vec4(s.step_y, 0),
                           {s.id, 0, 0, 0}});
    const gpu::Buffer receiver_buffer = gpu::Buffer::of(receivers), fractions(receivers.size() * 4);
    receiver_buffer.bind_storage(shaders::kReceiversBinding);
    fractions.bind_storage(shaders::kFractionsBinding);
    map.test_->set("count", int(receivers.size()));
    map.test_->dispatch(context, "visibility_test_receivers",
                        gpu::group_count(receivers.size(), 64));
    const auto found = fractions.download<float>(receivers.size());
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

}  // namespace photohull::visibility
