#include "core/error.h"

#include <cstdio>
#include <cstdlib>

namespace photohull {

void check_failed(const char* file, int line, const std::string& what) {
  std::fprintf(stderr, "%s:%d: internal error: check failed: %s\n", file, line, what.c_str());
  std::abort();
}

}  // namespace photohull
