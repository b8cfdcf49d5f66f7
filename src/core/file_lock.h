// One holder of a file at a time, on one machine or on several that share a file system.
#pragma once

#include <filesystem>
#include <memory>

namespace photohull {

/// Holds a file while it lives, which is made where it is not there and stays. The system lets go
/// of it when the process ends, however it does. Where the file system has no such locks, nothing
/// is held. A file, and not its folder (folder_lock.h): NFS gives locks only on files that are open
/// for writing (man 2 flock).
class FileLock {
 public:
  /// Null when somebody else holds the file.
  static std::unique_ptr<FileLock> if_free(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace photohull
