// The binary part of a GLB file, plain or compressed (EXT_meshopt_compression). Internal to
// io/mesh.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace photohull {

class GlbBuffers {
 public:
  using Json = nlohmann::ordered_json;

  explicit GlbBuffers(bool compress) : compress_(compress) {}

  /// Bytes as they are; returns the buffer view's index.
  std::size_t add_bytes(const void* data, std::size_t size);
  /// Values of vertices, each of `stride` bytes, a multiple of 4.
  template <typename T>
  std::size_t add_vertices(const std::vector<T>& values) {
    return add_vertices(values.data(), values.size(), sizeof(T));
  }
  /// Of triangles.
  std::size_t add_indices(const std::vector<std::uint32_t>& indices);

  /// Sets buffers, buffer views and the extensions that they need.
  void finish(Json& root);
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::size_t add_vertices(const void* data, std::size_t count, std::size_t stride);
  std::size_t add_view(const Json& view);
  /// Where `size` bytes begin that are appended, at a multiple of 4.
  std::size_t append(const void* data, std::size_t size);
  Json compressed(const std::vector<std::uint8_t>& code, std::size_t count, std::size_t stride,
                  const char* mode);

  bool compress_;
  Json views_ = Json::array();
  std::vector<std::uint8_t> bytes_;
  std::size_t plain_size_ = 0;  // of what is compressed
};

}  // namespace photohull
