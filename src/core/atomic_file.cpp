#include "core/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace photohull {
namespace fs = std::filesystem;
namespace {

std::string mend(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another folder";
    case EFBIG:
      return "raise the limit on file sizes or choose another file system";
    case ENOENT:
      return "create the folder first";
    case ENOTDIR:
      return "a part of the path is a file; choose another folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write to";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "check the disk and the path";
  }
}

[[noreturn]] void throw_write_error(const fs::path& target, int error_number) {
  const std::string reason = error_number ? std::strerror(error_number) : "the write was cut short";
  throw Error(
      concat("cannot write ", target.string(), ": ", reason, "; ", mend(error_number), "."));
}

/// Renaming over a device or a folder would destroy it or fail late, so both are refused early.
void check_replaceable(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw Error(concat("cannot write ", target.string(), ": it exists and is ",
                       fs::is_directory(status) ? "a folder" : "not a regular file",
                       "; choose another name."));
}

constexpr std::string_view kPartial = ".partial-";

/// A name that no other file of this or another running process has.
fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  fs::path name = target;
  name += concat(kPartial, ::getpid(), "-", counter++);
  return name;
}

/// Is it NAME.partial-PROCESS-COUNT?
bool is_temporary(const std::string& name) {
  const std::size_t at = name.rfind(kPartial);
  if (at == std::string::npos || at == 0) return false;
  const std::string_view rest = std::string_view(name).substr(at + kPartial.size());
  const std::size_t dash = rest.find_first_not_of("0123456789");
  return dash != 0 && dash != std::string_view::npos && rest[dash] == '-' &&
         dash + 1 < rest.size() &&
         rest.find_first_not_of("0123456789", dash + 1) == std::string_view::npos;
}

/// Removes temporaries of processes that were killed: those whose lock nobody holds any more.
void remove_abandoned(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (!is_temporary(entry.path().filename().string())) continue;
    const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(entry.path().c_str());
    ::close(descriptor);
  }
}

/// Once for every folder that the process writes to: looking takes time where there are many files.
void tidy_once(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  std::error_code ignored;
  const std::lock_guard lock(mutex);
  if (seen.insert(fs::weakly_canonical(folder, ignored)).second) remove_abandoned(folder);
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Makes the rename itself durable; some file systems cannot sync a folder, which is no failure.
void sync_folder(const fs::path& file) {
  const int descriptor = ::open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)) {
  check_replaceable(target_);
  std::error_code ignored;
  if (fs::is_symlink(target_, ignored)) {  // Replace what the link points at, not the link.
    const fs::path resolved = fs::weakly_canonical(target_, ignored);
    if (!ignored) target_ = resolved;
  }
  tidy_once(folder_of(target_));
  struct stat status {};
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    temporary_ = temporary_name(target_);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw_write_error(target_, errno);
    ::flock(descriptor_, LOCK_EX);  // shows that its process lives
    // Another process may have taken it for abandoned before the lock was there.
  } while (::fstat(descriptor_, &status) == 0 && status.st_nlink == 0);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(written < 0 ? errno : ENOSPC);
    bytes += written;
    size -= std::size_t(written);
  }
}

void AtomicFile::fail(int error_number) const { throw_write_error(target_, error_number); }

void AtomicFile::flush() const {
  // Some file systems (NFS, quotas) report a full disk only now.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP) fail(errno);
}

void AtomicFile::commit() {
  flush();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  ::close(std::exchange(descriptor_, -1));  // All is on the disk: nothing left to fail.
  sync_folder(target_);
}

void remove_file(const fs::path& path) {
  if (::unlink(path.c_str()) == 0)
    sync_folder(path);
  else if (errno != ENOENT)
    throw Error(concat("cannot remove ", path.string(), ": ", std::strerror(errno), "; ",
                       mend(errno), "."));
}

void write_atomically(const std::filesystem::path& path, std::string_view contents) {
  AtomicFile file(path);
  file.write(contents.data(), contents.size());
  file.commit();
}

}  // namespace photohull
