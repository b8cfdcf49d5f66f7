// Zip archives of files as they are. Internal to io/mesh.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/atomic_file.h"

namespace photohull {

/// Files without compression, each beginning at a multiple of 64 bytes, as USDZ asks for. Dates are
/// always the same, and so are the bytes.
class StoredZip {
 public:
  explicit StoredZip(AtomicFile& file) : file_(file) {}

  /// Throws Error beyond 4 GiB.
  void add(const std::string& name, std::span<const std::uint8_t> bytes);
  /// Writes the list of the files, after the last of them.
  void finish();

 private:
  struct Entry {
    std::string name;
    std::uint32_t crc, size, offset;
  };
  void write(const std::vector<std::uint8_t>& bytes);

  AtomicFile& file_;
  std::vector<Entry> entries_;
  std::uint64_t written_ = 0;
};

}  // namespace photohull
