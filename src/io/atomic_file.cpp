#include "io/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

/// Unlike any other writer's, in this process and beside it.
fs::path temporary_name(const fs::path& path) {
  static std::atomic<unsigned> serial{0};
  fs::path name = path;
  name += concat(".", ::getpid(), ".", serial.fetch_add(1), ".tmp");
  return name;
}

/// Removes the temporary file unless it was renamed.
struct Removal {
  fs::path path;
  ~Removal() {
    std::error_code ignored;
    if (!path.empty()) fs::remove(path, ignored);
  }
};

}  // namespace

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  Removal temporary{temporary_name(path)};
  write(temporary.path);
  std::error_code failure;
  fs::rename(temporary.path, path, failure);
  if (failure)
    throw Error(concat(path.string(), ": cannot be written (", failure.message(),
                       "); choose a folder that exists and is writable"));
  temporary.path.clear();
}

void write_atomically(const fs::path& path, std::string_view contents) {
  write_atomically(path, [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out.write(contents.data(), std::streamsize(contents.size()));
    out.close();
    if (!out)
      throw Error(concat(path.string(), ": cannot be written (", std::strerror(errno),
                         "); choose a folder that exists, is writable and has space"));
  });
}

}  // namespace photohull::io
