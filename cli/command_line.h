// The command line as a whole: what can be written on it, and what becomes of it.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

namespace photohull::cli {

/// The parser with every command. To parse is to run the command that was chosen.
std::unique_ptr<CLI::App> make_parser();

/// Runs a command line to its end. Messages go to standard error: one that begins with "photohull:
/// " and is the last, where the exit code that is returned is not 0 (--help lists them).
int run_command_line(int argc, const char* const* argv);

}  // namespace photohull::cli
