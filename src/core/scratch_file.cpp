#include "core/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>

namespace photohull {
namespace {

/// pread or pwrite until all is done.
template <typename Transfer, typename Byte>
bool transfer_all(Transfer transfer, int file, Byte* bytes, std::size_t size, std::int64_t at) {
  while (file >= 0 && size > 0) {
    const ssize_t done = transfer(file, bytes, size, at);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done, at += done, size -= std::size_t(done);
  }
  return file >= 0;
}

}  // namespace

ScratchFile::ScratchFile(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  file_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file_ >= 0) return;
  // Some file systems have no files without names: this one loses its name at once.
  std::string name = (folder / ".photohull-scratch-XXXXXX").string();
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ >= 0) ::unlink(name.c_str());
}

ScratchFile::~ScratchFile() {
  if (file_ >= 0) ::close(file_);
}

bool ScratchFile::write(std::int64_t at, const void* data, std::size_t size) {
  return transfer_all(::pwrite, file_, static_cast<const char*>(data), size, at);
}

bool ScratchFile::read(std::int64_t at, void* data, std::size_t size) const {
  return transfer_all(::pread, file_, static_cast<char*>(data), size, at);
}

}  // namespace photohull
