// The program ffmpeg as a child process that takes pictures. Private to io.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"

namespace photohull::io {

/// Runs until it has been given all; killed where it is not finished. Ctrl-C on a terminal does not
/// reach it: who holds it decides what becomes of its file.
class Ffmpeg {
 public:
  /// `words` are its arguments; `target` is the file that messages name. Throws Error where it is
  /// not installed.
  Ffmpeg(std::filesystem::path target, const std::vector<std::string>& words,
         const Progress& progress);
  ~Ffmpeg();
  Ffmpeg(const Ffmpeg&) = delete;
  Ffmpeg& operator=(const Ffmpeg&) = delete;

  /// To its standard input. Throws Error with its own words where it has ended; Cancelled.
  void write(std::span<const std::uint8_t> bytes);
  /// Ends its input and waits for it. Throws Error where it did not end well; Cancelled.
  void finish();

 private:
  [[noreturn]] void fail(int status);
  int wait();
  void end_now();

  std::filesystem::path target_;
  const Progress& progress_;
  pid_t child_ = 0;
  int input_ = -1;     // our end of its standard input
  int messages_ = -1;  // a file in memory: its standard error
};

}  // namespace photohull::io
