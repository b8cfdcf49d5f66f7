// Libraries start threads before main() does, and end the process by a signal where these get no
// memory. What stands here runs before them, with nothing but the system's own calls.
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "cli/front/exit_code.h"

namespace {

constexpr rlim_t kMebibyte = 1 << 20;
constexpr rlim_t kLibraries = 96 * kMebibyte;  // of their data, and some to spare
constexpr rlim_t kUsualStack = 8 * kMebibyte;

void say_that_memory_is_short() {
  constexpr char kText[] =
      "photohull: this process may take so little memory (ulimit -d) that its libraries cannot "
      "start; raise the limit\n";
  syscall(SYS_write, STDERR_FILENO, kText, sizeof(kText) - 1);
}

void check_before_libraries(int, char**, char**) {
  rlimit data{}, stack{};
  if (getrlimit(RLIMIT_DATA, &data) != 0 || data.rlim_cur == RLIM_INFINITY) return;
  if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur == RLIM_INFINITY)
    stack.rlim_cur = kUsualStack;
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  if (data.rlim_cur >= kLibraries + rlim_t(cores > 0 ? cores : 1) * stack.rlim_cur) return;
  say_that_memory_is_short();
  _exit(photohull::cli::exit_code(photohull::ErrorKind::kFailed));
}

[[gnu::section(".preinit_array"),
  gnu::used]] void (*const kBeforeLibraries)(int, char**, char**) = check_before_libraries;

}  // namespace
