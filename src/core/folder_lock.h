// One job at a time in a folder.
#pragma once

#include <filesystem>
#include <string>

namespace photohull {

/// Holds a folder while it lives. The system lets go of it when the process ends, however it does,
/// and nothing is left in the folder. Where the file system has no such locks, nothing is held.
class FolderLock {
 public:
  /// Throws Error when another job holds the folder, which is the value of `option`.
  FolderLock(const std::filesystem::path& folder, const std::string& option);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace photohull
