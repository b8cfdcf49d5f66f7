// Space on a disk for what memory does not hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace photohull {

/// A file without a name: it is gone when the object or the process ends, however that ends.
class ScratchFile {
 public:
  /// In a folder that exists; an empty path, or a folder that takes no files, gives none.
  explicit ScratchFile(const std::filesystem::path& folder);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// From several threads at once, at places that do not overlap. False where that fails, as it
  /// does on a full disk.
  bool write(std::int64_t at, const void* data, std::size_t size);
  bool read(std::int64_t at, void* data, std::size_t size) const;

 private:
  int file_ = -1;
};

}  // namespace photohull
