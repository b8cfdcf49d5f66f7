// One job at a time in a folder.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace photohull {

/// Holds a folder while it lives. The system lets go of it when the process ends, however it does,
/// and nothing is left in the folder. Where the file system has no such locks, nothing is held.
class FolderLock {
 public:
  /// Throws Error when another job holds the folder, which is the value of `option`.
  FolderLock(const std::filesystem::path& folder, const std::string& option);
  /// Null when another job holds the folder.
  static std::unique_ptr<FolderLock> if_free(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace photohull
