#include "terminal_progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace photohull::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kBarWidth = 30;
constexpr auto kRedraw = std::chrono::milliseconds(100);

double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

bool takes_escape_sequences() {
  const char *term = std::getenv("TERM"), *no_colour = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) && !(term && std::string_view(term) == "dumb") &&
         !(no_colour && *no_colour);
}

}  // namespace

TerminalProgress::TerminalProgress(double total_weight)
    : start_(Clock::now()), total_(total_weight), terminal_(takes_escape_sequences()) {}

TerminalProgress::~TerminalProgress() { finish(); }

void TerminalProgress::stage(const std::string& name, double weight) {
  done_ += weight_;
  weight_ = weight;
  name_ = name;
  if (terminal_)
    draw(0);
  else
    std::fprintf(stderr, "[%7.2f s] %s\n", seconds_since(start_), name.c_str());
}

void TerminalProgress::update(double fraction) {
  if (terminal_ && Clock::now() - drawn_ > kRedraw) draw(fraction);
}

void TerminalProgress::draw(double fraction) {
  drawn_ = Clock::now();
  open_line_ = true;
  const double share =
      std::clamp((done_ + weight_ * std::clamp(fraction, 0.0, 1.0)) / total_, 0.0, 1.0);
  const int filled = int(share * kBarWidth);
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
  const double elapsed = seconds_since(start_);
  char left[32] = "";
  if (share > 0.02 && elapsed > 0.5)
    std::snprintf(left, sizeof left, ", %.0f s left", elapsed * (1 - share) / share);
  std::fprintf(stderr, "\r\033[K[%s] %3.0f %% %s%s", bar.c_str(), 100 * share, name_.c_str(), left);
  std::fflush(stderr);
}

void TerminalProgress::clear_line() {
  if (open_line_) std::fputs("\r\033[K", stderr);
  open_line_ = false;
}

void TerminalProgress::warn(const std::string& message) {
  clear_line();
  std::fprintf(stderr, "warning: %s\n", message.c_str());
}

void TerminalProgress::note(const std::string& message) {
  clear_line();
  std::fprintf(stderr, "note: %s\n", message.c_str());
}

void TerminalProgress::finish() { clear_line(); }

}  // namespace photohull::cli
