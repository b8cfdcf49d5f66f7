// Shader storage and uniform buffers.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace photohull::gpu {

/// A move-only GL buffer object of fixed size.
class Buffer {
 public:
  Buffer() = default;
  /// Throws Error when the device cannot hold it.
  explicit Buffer(std::size_t bytes, const void* data = nullptr);
  ~Buffer();
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }

  template <typename T>
  static Buffer of(std::span<const T> values) {
    return Buffer(values.size_bytes(), values.data());
  }
  template <typename T>
  static Buffer of(const std::vector<T>& values) {
    return of(std::span<const T>(values));
  }

  unsigned id() const { return id_; }
  std::size_t bytes() const { return bytes_; }
  /// Throws Error when it is larger than the device's storage blocks.
  void bind_storage(unsigned binding) const;
  void bind_uniform(unsigned binding) const;
  void write(std::size_t offset, std::size_t size, const void* data);
  void read(std::size_t offset, std::size_t size, void* data) const;
  /// Sets every 32-bit word.
  void fill(unsigned word);

  template <typename T>
  std::vector<T> download(std::size_t count, std::size_t first = 0) const {
    std::vector<T> values(count);
    if (count) read(first * sizeof(T), count * sizeof(T), values.data());
    return values;
  }

 private:
  void swap(Buffer& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
  }
  unsigned id_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace photohull::gpu
