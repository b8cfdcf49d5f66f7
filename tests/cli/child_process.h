// Runs the program under test as a child process.
#pragma once

#include <sys/resource.h>

#include <optional>
#include <string>
#include <vector>

namespace photohull::test {

struct RunOptions {
  /// Standard error goes to a pseudo-terminal of 100 columns instead of a pipe.
  bool error_terminal = false;
  /// No file may grow beyond this many bytes: writes fail as on a full disk.
  std::optional<rlim_t> file_size_limit;
  /// The child's data may not grow beyond this many bytes: allocations fail.
  std::optional<rlim_t> data_limit;
  /// The child is killed when it has used so many seconds of a processor, which fails the test.
  std::optional<rlim_t> cpu_seconds;
  /// Standard output goes to this file (/dev/full, say) instead of a pipe.
  std::string output_file;
  /// Nobody reads standard output: whoever did has closed the pipe.
  bool output_closed = false;
  /// Files' permissions hold for the child even where the tests run as root, who may read all.
  bool obeys_permissions = false;
  /// `signal` is sent once, so many seconds after this text has come on standard error.
  std::string signal_after;
  double signal_delay_seconds = 0;
  int signal = 0;
  /// The child may end before it gets the signal.
  bool may_end_before_signal = false;
  /// NAME=VALUE, each added to the child's environment.
  std::vector<std::string> environment;
  /// Where the child works; the test's own folder when empty.
  std::string working_folder;
  /// The child is killed after this time, which fails the test.
  double timeout_seconds = 120;
};

struct Finished {
  int code = -1;   ///< exit code; -1 when a signal ended the process
  int signal = 0;  ///< that signal
  std::string out, err;

  /// Lines of standard error that start with `prefix`.
  std::vector<std::string> error_lines(const std::string& prefix = "") const;
};

using Arguments = std::vector<std::string>;

/// Runs `photohull arguments...` to its end. Crashes, time-outs and reports of the sanitizers are
/// test failures.
Finished run_photohull(const Arguments& arguments, const RunOptions& options = {});

/// The same for any program on the path; its exit code is -1 when it cannot be started.
Finished run_program(const Arguments& command, const RunOptions& options = {});

}  // namespace photohull::test
