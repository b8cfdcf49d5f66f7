#include "cli/front/command_line.h"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "cli/front/exit_code.h"
#include "cli/front/parse_faults.h"
#include "core/error.h"
#include "core/progress.h"

namespace photohull::cli {
namespace {

extern "C" void on_interrupt(int signal) {
  // The second Ctrl-C ends the process at once.
  if (process_cancellation().cancelled()) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  process_cancellation().cancel();
}

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

/// Whoever read standard output has enough of it, as `head -1` has.
bool reader_is_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & (POLLERR | POLLHUP));
}

/// A full disk behind standard output is a failure too; a closed pipe is not.
void check_output() {
  const bool written = std::fflush(stdout) == 0 && !std::ferror(stdout);
  if (!written && !reader_is_gone()) throw Error("standard output could not be written in full");
}

void run(int argc, const char* const* argv, const Commands& commands) {
  const std::unique_ptr<CLI::App> app = make_parser(commands);
  // A command would run before what stands in front of it is looked at.
  if (argc > 2 && argv[1] == std::string("--json") && argv[2][0] != '-')
    throw UsageError("--json stands behind the command, or with --version; see --help");
  try {
    app->parse(argc, argv);
    const bool version = app->count("--version") > 0, json = app->count("--json") > 0;
    if (version)
      std::fputs((json ? commands.version_json() : "photohull " PHOTOHULL_VERSION "\n").c_str(),
                 stdout);
    else if (app->get_subcommands().empty())
      throw UsageError(
          concat("a command is missing: one of ", joined(command_names(*app)), "; see --help"));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) throw UsageError(parse_fault(*app, e));
    app->exit(e);  // prints the help
  }
  check_output();
}

}  // namespace

std::unique_ptr<CLI::App> make_parser(const Commands& commands) {
  auto app = std::make_unique<CLI::App>(
      "photohull turns calibrated photographs into a volume and a mesh by carving space.");
  app->add_flag("--version")->description("print the version");
  app->add_flag("--json")->description("with --version: version, commit, libraries, device");
  app->require_subcommand(0, 1);
  app->footer(
      "Examples:\n"
      "  photohull info datasets/templeSparseRing\n"
      "  photohull reconstruct datasets/templeSparseRing --out out/temple\n"
      "  photohull reconstruct scan/transforms.json --out out/scan --quality draft\n\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 done, but the result failed its own checks,\n"
      "4 the graphics device failed (out of memory, or lost), 130 cancelled.");
  commands.add(*app);
  return app;
}

int run_command_line(int argc, const char* const* argv, const Commands& commands) {
  return report_failures([&] { run(argc, argv, commands); });
}

int report_failures(const std::function<void()>& work) {
  try {
    work();
    return kExitSuccess;
  } catch (const Error& e) {
    std::fprintf(stderr, "photohull: %s\n", e.what());
    return exit_code(e.kind());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "photohull: out of memory; lower --resolution or use fewer --views\n");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "photohull: unexpected failure: %s\n", e.what());
  }
  return exit_code(ErrorKind::kFailed);
}

void handle_signals() {
  process_cancellation();  // is made here, not in a handler
  // What the caller ignores (nohup, background jobs of scripts) stays ignored.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, SIG_IGN) != SIG_IGN) std::signal(signal, on_interrupt);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit becomes a write error with a message
}

}  // namespace photohull::cli
