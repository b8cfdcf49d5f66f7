#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

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

int run(int argc, char** argv) {
  CLI::App app{"photohull turns calibrated photographs into a volume and a mesh by carving space."};
  app.set_version_flag("--version", "photohull " PHOTOHULL_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  photohull info datasets/templeSparseRing\n"
      "  photohull reconstruct datasets/templeSparseRing --out out/temple\n"
      "  photohull reconstruct scan/transforms.json --out out/scan --quality draft\n\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage, 130 cancelled.");
  photohull::cli::add_reconstruct(app);
  photohull::cli::add_info(app);
  photohull::cli::add_devices(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return code == 0 ? 0 : int(photohull::ExitCode::kUsage);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
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
