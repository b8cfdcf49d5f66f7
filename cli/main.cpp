#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "commands.h"
#include "core/error.h"
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

/// The parser's message as one sentence.
std::string one_line(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && (message.back() == ' ' || message.back() == '.')) message.pop_back();
  return message + "; see --help";
}

int run(int argc, char** argv) {
  CLI::App app{"photohull turns calibrated photographs into a volume and a mesh by carving space."};
  app.set_version_flag("--version", "photohull " PHOTOHULL_VERSION);
  app.require_subcommand(0, 1);
  app.footer(
      "Examples:\n"
      "  photohull info datasets/templeSparseRing\n"
      "  photohull reconstruct datasets/templeSparseRing --out out/temple --refine-cameras auto\n"
      "  photohull reconstruct scan/transforms.json --out out/scan --quality draft\n\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 done, but the result failed its own checks, "
      "130\n"
      "cancelled.");
  photohull::cli::add_reconstruct(app);
  photohull::cli::add_info(app);
  photohull::cli::add_masks(app);
  photohull::cli::add_convert(app);
  photohull::cli::add_calibrate(app);
  photohull::cli::add_refine_cameras(app);
  photohull::cli::add_synthesize(app);
  photohull::cli::add_evaluate(app);
  photohull::cli::add_chart(app);
  photohull::cli::add_stress(app);
  photohull::cli::add_bench(app);
  photohull::cli::add_devices(app);
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty())
      throw photohull::UsageError(
          "a command is missing: reconstruct, evaluate, masks, synthesize, convert, calibrate, "
          "refine-cameras, "
          "chart, bench, info or "
          "devices; "
          "see "
          "--help");
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) throw photohull::UsageError(one_line(e.what()));
    app.exit(e);  // prints the help or the version
  }
  // A full disk or a closed pipe behind standard output is a failure too.
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throw photohull::Error("standard output could not be written in full");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // What the caller ignores (nohup, background jobs of scripts) stays ignored.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, SIG_IGN) != SIG_IGN) std::signal(signal, on_interrupt);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit becomes a write error with a message
  try {
    return run(argc, argv);
  } catch (const photohull::Error& e) {
    std::fprintf(stderr, "photohull: %s\n", e.what());
    return int(e.code());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "photohull: out of memory; lower --resolution or use fewer --views\n");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "photohull: unexpected failure: %s\n", e.what());
  }
  return int(photohull::ExitCode::kFailure);
}
