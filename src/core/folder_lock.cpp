#include "core/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull {

namespace {

/// Holds the folder by its descriptor, which is -1 where the folder cannot be opened. False:
/// another job holds it.
bool hold(const std::filesystem::path& folder, int& descriptor) {
  descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
    return true;
  ::close(descriptor);
  descriptor = -1;
  return false;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& option) {
  if (!hold(folder, descriptor_))
    throw Error(concat(option_word(option, folder.string()),
                       ": another photohull is at work there; wait until it has ended, or choose "
                       "another folder"));
}

std::unique_ptr<FolderLock> FolderLock::if_free(const std::filesystem::path& folder) {
  int descriptor = -1;
  if (!hold(folder, descriptor)) return nullptr;
  return std::unique_ptr<FolderLock>(new FolderLock(descriptor));
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace photohull
