#include <glog/logging.h>

#include <csignal>

#include "command_line.h"
#include "core/progress.h"

namespace {

extern "C" void on_interrupt(int signal) {
  // The second Ctrl-C ends the process at once.
  if (photohull::cancellation_requested()) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  photohull::request_cancellation();
}

}  // namespace

int main(int argc, char** argv) {
  // Ceres notes there what its summaries tell as well; users get a sentence instead.
  FLAGS_minloglevel = google::GLOG_FATAL;
  // What the caller ignores (nohup, background jobs of scripts) stays ignored.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, SIG_IGN) != SIG_IGN) std::signal(signal, on_interrupt);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit becomes a write error with a message
  return photohull::cli::run_command_line(argc, argv);
}
