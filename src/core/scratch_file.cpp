#include "core/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>

namespace photohull {

ScratchFile::ScratchFile(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  file_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file_ >= 0) return;
  std::string name = (folder / ".photohull-scratch-XXXXXX").string();  // not all file systems can
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ >= 0) ::unlink(name.c_str());
}

ScratchFile::~ScratchFile() {
  if (file_ >= 0) ::close(file_);
}

bool ScratchFile::write(std::int64_t at, const void* data, std::size_t size) {
  const auto* from = static_cast<const char*>(data);
  while (file_ >= 0 && size > 0) {
    const ssize_t done = ::pwrite(file_, from, size, at);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    from += done, at += done, size -= std::size_t(done);
  }
  return file_ >= 0;
}

bool ScratchFile::read(std::int64_t at, void* data, std::size_t size) const {
  auto* to = static_cast<char*>(data);
  while (file_ >= 0 && size > 0) {
    const ssize_t done = ::pread(file_, to, size, at);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    to += done, at += done, size -= std::size_t(done);
  }
  return file_ >= 0;
}

}  // namespace photohull
