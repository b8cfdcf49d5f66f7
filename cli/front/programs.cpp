#include "cli/front/programs.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace photohull::cli {

std::filesystem::path program_beside(std::string_view name) {
  std::error_code failure;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failure);
  if (failure) throw Error(concat("/proc/self/exe: ", failure.message()));
  return self.parent_path() / name;
}

void become_program(std::string_view name, char** argv) {
  const auto program = program_beside(name);
  ::execv(program.c_str(), argv);
  throw Error(concat(program.string(), ": cannot be started: ", std::strerror(errno),
                     "; it belongs beside photohull"));
}

}  // namespace photohull::cli
