// Errors that a user can cause, and checks for those that only a programmer can.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace photohull {

/// What the process reports to its caller.
enum class ExitCode : int {
  kSuccess = 0,
  kFailure = 1,     ///< The job could not be done with this input or on this machine.
  kUsage = 2,       ///< The command line is wrong.
  kCancelled = 130  ///< Ctrl-C.
};

/// A user-facing failure. The message is one sentence: the file, the field, what was found, the
/// mend.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, ExitCode code = ExitCode::kFailure)
      : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// An option or argument outside its legal range (exit code 2).
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(message, ExitCode::kUsage) {}
};

/// What would have been done does not fit into memory: no fault of the input (exit code 1).
class MemoryError : public Error {
 public:
  explicit MemoryError(const std::string& message) : Error(message) {}
};

/// Thrown at the next safe point after the user asked to stop (exit code 130).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled", ExitCode::kCancelled) {}
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
