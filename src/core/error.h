// Errors that a user can cause, and checks for those that only a programmer can.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace photohull {

/// What kind of failure it is: for programs, which act on it. The command line makes its exit code
/// of it (cli/front/exit_code.h).
enum class ErrorKind {
  kFailed,    ///< the job cannot be done with this input or on this machine
  kUsage,     ///< options that are wrong, or do not go together
  kMemory,    ///< what would have been done does not fit into memory
  kDevice,    ///< the graphics device is lost, or out of memory
  kDoubted,   ///< there is a result, and it failed its own checks
  kCancelled  ///< the caller asked to stop
};

/// A user-facing failure. The message is one sentence: the file, the field, what was found, the
/// mend.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, ErrorKind kind = ErrorKind::kFailed)
      : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// An option or argument outside its legal range.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(message, ErrorKind::kUsage) {}
};

/// What would have been done does not fit into memory: no fault of the input.
class MemoryError : public Error {
 public:
  explicit MemoryError(const std::string& message) : Error(message, ErrorKind::kMemory) {}
};

/// Thrown at the next safe point after the user asked to stop.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled", ErrorKind::kCancelled) {}
};

/// Joins its arguments with operator<<.
template <typename... Args>
std::string concat(const Args&... args) {
  std::ostringstream out;
  (out << ... << args);
  return out.str();
}

[[noreturn]] void check_failed(const char* file, int line, const std::string& what);

}  // namespace photohull

/// Programmer errors: abort with the expression.
#define PHOTOHULL_CHECK(condition)                                               \
  do {                                                                           \
    if (!(condition)) ::photohull::check_failed(__FILE__, __LINE__, #condition); \
  } while (false)

/// Programmer errors: abort with both operands printed.
#define PHOTOHULL_CHECK_OP(a, op, b)                                                    \
  do {                                                                                  \
    const auto& check_a = (a);                                                          \
    const auto& check_b = (b);                                                          \
    if (!(check_a op check_b))                                                          \
      ::photohull::check_failed(                                                        \
          __FILE__, __LINE__,                                                           \
          ::photohull::concat(#a " " #op " " #b, " (", check_a, " vs ", check_b, ")")); \
  } while (false)
