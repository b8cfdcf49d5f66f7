// Lists of plain values as bytes, for files that the same program reads again on the same kind of
// machine.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/grid.h"

namespace photohull {

/// Each list is its length, of 8 bytes, and its values as memory has them.
class ListWriter {
 public:
  using Put = std::function<void(const void*, std::size_t)>;
  explicit ListWriter(Put put) : put_(std::move(put)) {}
  /// Appends to a text, which outlives it.
  explicit ListWriter(std::string& text)
      : put_([&text](const void* data, std::size_t size) {
          text.append(static_cast<const char*>(data), size);
        }) {}

  template <typename T>
  void list(std::span<const T> items) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::uint64_t count = items.size();
    put_(&count, sizeof count);
    put_(items.data(), items.size_bytes());
  }
  template <typename T>
  void list(const std::vector<T>& items) {
    list(std::span<const T>(items));
  }
  template <typename T>
  void one(const T& item) {
    list(std::span<const T>(&item, 1));
  }
  void text(std::string_view text) { list(std::span<const char>(text)); }

 private:
  Put put_;
};

/// Reads them in the same order. Throws Error where the bytes end too early or a list has another
/// length; no list takes more memory than there are bytes.
class ListReader {
 public:
  /// Reads so many bytes; false where there are fewer.
  using Take = std::function<bool(void*, std::size_t)>;
  ListReader(Take take, std::uint64_t bytes) : take_(std::move(take)), left_(bytes) {}
  /// Of a text, which outlives it.
  explicit ListReader(std::string_view text)
      : take_([text, at = std::size_t(0)](void* target, std::size_t size) mutable {
          std::memcpy(target, text.data() + at, size);
          at += size;
          return true;
        }),
        left_(text.size()) {}

  template <typename T>
  std::vector<T> list() {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t count = 0;
    take(&count, sizeof count);
    if (count > left_ / sizeof(T)) throw Error("it ends too early");
    std::vector<T> items(count);
    take(items.data(), count * sizeof(T));
    return items;
  }
  template <typename T>
  T one() {
    const std::vector<T> items = list<T>();
    if (items.size() != 1) throw Error("a part of it has another size");
    return items.front();
  }
  std::string text() {
    const std::vector<char> letters = list<char>();
    return {letters.begin(), letters.end()};
  }
  bool at_end() const { return left_ == 0; }

 private:
  void take(void* target, std::uint64_t bytes) {
    if (bytes > left_ || (bytes > 0 && !take_(target, bytes))) throw Error("it ends too early");
    left_ -= bytes;
  }

  Take take_;
  std::uint64_t left_;
};

void write_volume(const SparseVolume& volume, ListWriter& to);
/// Throws Error also where the volume contradicts itself.
SparseVolume read_volume(ListReader& from);

}  // namespace photohull
