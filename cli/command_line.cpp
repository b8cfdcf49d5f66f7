#include "command_line.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "commands.h"
#include "core/error.h"

namespace photohull::cli {
namespace {

/// The parser's message as one sentence.
std::string one_line(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && (message.back() == ' ' || message.back() == '.')) message.pop_back();
  return message + "; see --help";
}

std::string command_names(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

void run(int argc, const char* const* argv) {
  const std::unique_ptr<CLI::App> app = make_parser();
  try {
    app->parse(argc, argv);
    if (app->get_subcommands().empty())
      throw UsageError(
          concat("a command is missing: one of ", command_names(*app), "; see --help"));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) throw UsageError(one_line(e.what()));
    app->exit(e);  // prints the help or the version
  }
  // A full disk or a closed pipe behind standard output is a failure too.
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throw Error("standard output could not be written in full");
}

}  // namespace

std::unique_ptr<CLI::App> make_parser() {
  auto app = std::make_unique<CLI::App>(
      "photohull turns calibrated photographs into a volume and a mesh by carving space.");
  app->set_version_flag("--version", "photohull " PHOTOHULL_VERSION);
  app->require_subcommand(0, 1);
  app->footer(
      "Examples:\n"
      "  photohull info datasets/templeSparseRing\n"
      "  photohull reconstruct datasets/templeSparseRing --out out/temple\n"
      "  photohull reconstruct scan/transforms.json --out out/scan --quality draft\n\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 done, but the result failed its own checks,\n"
      "4 the graphics device failed (out of memory, or lost), 130 cancelled.");
  add_reconstruct(*app);
  add_info(*app);
  add_masks(*app);
  add_convert(*app);
  add_calibrate(*app);
  add_refine_cameras(*app);
  add_synthesize(*app);
  add_evaluate(*app);
  add_chart(*app);
  add_stress(*app);
  add_bench(*app);
  add_devices(*app);
  return app;
}

int run_command_line(int argc, const char* const* argv) {
  try {
    run(argc, argv);
    return int(ExitCode::kSuccess);
  } catch (const Error& e) {
    std::fprintf(stderr, "photohull: %s\n", e.what());
    return int(e.code());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "photohull: out of memory; lower --resolution or use fewer --views\n");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "photohull: unexpected failure: %s\n", e.what());
  }
  return int(ExitCode::kFailure);
}

}  // namespace photohull::cli
