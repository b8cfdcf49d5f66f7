// What the process reports to its caller.
#pragma once

#include "core/error.h"

namespace photohull::cli {

inline constexpr int kExitSuccess = 0;

constexpr int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kFailed:
    case ErrorKind::kMemory:
      return 1;
    case ErrorKind::kUsage:
      return 2;
    case ErrorKind::kDoubted:
      return 3;
    case ErrorKind::kDevice:
      return 4;
    case ErrorKind::kCancelled:
      return 130;
  }
  return 1;
}

}  // namespace photohull::cli
