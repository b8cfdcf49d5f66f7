// Programs run, heard and measured.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"

namespace photohull {

struct Finished {
  int exit_code = -1;      ///< -1 when a signal ended the process
  int signal = 0;          ///< that signal
  bool timed_out = false;  ///< killed at the time limit
  std::string out;         ///< standard output
  std::string err;         ///< the last 4 KiB of standard error
  double wall_seconds = 0;
  double user_seconds = 0, system_seconds = 0;  ///< all threads, and children it waited for
  std::int64_t peak_memory_bytes = 0;           ///< largest resident set

  bool ok() const { return exit_code == 0 && !timed_out; }
  double cpu_seconds() const { return user_seconds + system_seconds; }
};

/// Takes what a program prints on either stream, in pieces as they come.
using Listener = std::function<void(std::string_view)>;

/// Runs `program arguments...` in a process group of its own, with nothing on standard input, until
/// it ends or `time_limit_seconds` are over; then the whole group is killed. Cancellation kills it
/// too and throws Cancelled. It dies with this process. A name without a slash is looked for on the
/// PATH. Throws Error when it cannot be started or prints more than 256 MiB.
Finished run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   double time_limit_seconds, const Progress& progress,
                   const Listener& listener = {});

/// Is there a program of that name on the PATH?
bool is_on_path(const std::string& program);

}  // namespace photohull
