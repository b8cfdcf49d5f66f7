// Codecs: EXT_meshopt_compression, version 1 of indices and 0 of vertices.
#include "io/mesh/glb_buffers.h"

#include <meshoptimizer.h>

#include <algorithm>

#include "core/error.h"
#include "io/mesh/gltf_file.h"

namespace photohull {
namespace {

enum Target { kVertices = 34962, kIndices = 34963 };

}  // namespace

std::size_t GlbBuffers::append(const void* data, std::size_t size) {
  bytes_.resize((bytes_.size() + 3) / 4 * 4, 0);
  const std::size_t begin = bytes_.size();
  const auto* first = static_cast<const std::uint8_t*>(data);
  bytes_.insert(bytes_.end(), first, first + size);
  return begin;
}

std::size_t GlbBuffers::add_view(const Json& view) {
  views_.push_back(view);
  return views_.size() - 1;
}

std::size_t GlbBuffers::add_bytes(const void* data, std::size_t size) {
  const std::size_t begin = append(data, size);
  return add_view({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", size}});
}

/// A view into a buffer that no file has: readers decode it from the first.
GlbBuffers::Json GlbBuffers::compressed(const std::vector<std::uint8_t>& code, std::size_t count,
                                        std::size_t stride, const char* mode) {
  const std::size_t begin = append(code.data(), code.size());
  Json view = {{"buffer", 1}, {"byteOffset", plain_size_}, {"byteLength", count * stride}};
  view["extensions"][kMeshoptCompression] = {
      {"buffer", 0},          {"byteOffset", begin}, {"byteLength", code.size()},
      {"byteStride", stride}, {"count", count},      {"mode", mode}};
  plain_size_ += (count * stride + 3) / 4 * 4;
  return view;
}

std::size_t GlbBuffers::add_vertices(const void* data, std::size_t count, std::size_t stride) {
  PHOTOHULL_CHECK(stride % 4 == 0);
  Json view;
  if (compress_) {
    std::vector<std::uint8_t> code(meshopt_encodeVertexBufferBound(count, stride));
    meshopt_encodeVertexVersion(0);
    code.resize(meshopt_encodeVertexBuffer(code.data(), code.size(), data, count, stride));
    view = compressed(code, count, stride, "ATTRIBUTES");
  } else {
    const std::size_t begin = append(data, count * stride);
    view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", count * stride}};
  }
  view["byteStride"] = stride;
  view["target"] = int(kVertices);
  return add_view(view);
}

std::size_t GlbBuffers::add_indices(const std::vector<std::uint32_t>& indices) {
  constexpr std::size_t kBytes = sizeof(std::uint32_t);
  Json view;
  if (compress_) {
    std::uint32_t most = 0;
    for (const std::uint32_t i : indices) most = std::max(most, i);
    std::vector<std::uint8_t> code(
        meshopt_encodeIndexBufferBound(indices.size(), std::size_t(most) + 1));
    meshopt_encodeIndexVersion(1);
    code.resize(
        meshopt_encodeIndexBuffer(code.data(), code.size(), indices.data(), indices.size()));
    view = compressed(code, indices.size(), kBytes, "TRIANGLES");
  } else {
    const std::size_t begin = append(indices.data(), indices.size() * kBytes);
    view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", indices.size() * kBytes}};
  }
  view["target"] = int(kIndices);
  return add_view(view);
}

void GlbBuffers::finish(Json& root) {
  root["bufferViews"] = views_;
  bytes_.resize((bytes_.size() + 3) / 4 * 4, 0);
  root["buffers"] = {{{"byteLength", bytes_.size()}}};
  if (!compress_) return;
  root["buffers"].push_back({{"byteLength", plain_size_}});
  root["buffers"][1]["extensions"][kMeshoptCompression] = {{"fallback", true}};
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    root[list] = {kMeshoptCompression, "KHR_mesh_quantization"};
}

}  // namespace photohull
