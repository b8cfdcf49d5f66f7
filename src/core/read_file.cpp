#include "core/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace photohull {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path)
      : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what,
                       const char* mend) {
  throw Error(concat("cannot read ", path.string(), ": ", what, "; ", mend));
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))  // else a pipe would be waited for
    fail(path, "it is no file", "check the path");
  const Descriptor file(path);
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0)
    fail(path, std::strerror(errno), "it cannot be opened, check its permissions");
  std::string bytes(std::size_t(status.st_size), '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, std::strerror(errno), "check the disk");
    if (count == 0)
      fail(path, concat("it ends after ", done, " of its ", bytes.size(), " bytes"),
           "check the disk, or whether another program is writing it");
    done += std::size_t(count);
  }
  return bytes;
}

}  // namespace photohull
