// The command line as a whole: what can be written on it, and what becomes of it.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

namespace photohull::cli {

/// A part of the command line that one program serves.
struct Commands {
  void (*add)(CLI::App& app);     ///< adds the commands to the parser
  std::string (*version_json)();  ///< what --version --json prints; nullptr: never asked for
};

/// The parser with these commands. To parse is to run the command that was chosen.
std::unique_ptr<CLI::App> make_parser(const Commands& commands);

/// Runs a command line to its end. Messages go to standard error: one that begins with "photohull:
/// " and is the last, where the exit code that is returned is not 0 (--help lists them).
int run_command_line(int argc, const char* const* argv, const Commands& commands);

/// Calls the work; says what it throws, and returns the exit code, as run_command_line does.
int report_failures(const std::function<void()>& work);

/// For main: makes Ctrl-C and its like cancel the job, a second one end the process at once, and
/// closed pipes and file-size limits failures with a message.
void handle_signals();

}  // namespace photohull::cli
