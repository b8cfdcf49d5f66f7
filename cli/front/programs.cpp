#include "cli/front/programs.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "core/error.h"

namespace photohull::cli {
namespace {

/// Lets the C library keep memory that was freed, in large pages. Stages allocate photographs and
/// pyramids of the same sizes again and again, and the kernel clears each page that it hands out:
/// without this that takes a tenth of a job. glibc reads it when a program starts; what the user
/// has set stays.
void keep_freed_memory() {
  ::setenv("GLIBC_TUNABLES",
           "glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=33554432:"
           "glibc.malloc.trim_threshold=268435456",
           0);
}

}  // namespace

std::filesystem::path program_beside(std::string_view name) {
  std::error_code failure;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failure);
  if (failure) throw Error(concat("/proc/self/exe: ", failure.message()));
  return self.parent_path() / name;
}

void become_program(std::string_view name, char** argv) {
  const auto program = program_beside(name);
  keep_freed_memory();
  ::execv(program.c_str(), argv);
  throw Error(concat(program.string(), ": cannot be started: ", std::strerror(errno),
                     "; it belongs beside photohull"));
}

}  // namespace photohull::cli
