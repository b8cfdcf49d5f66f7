// The commands, before any of them is loaded: what they are called, what they do, and which program
// runs them.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string_view>

namespace photohull::cli {

/// Runs all commands but those of the lab.
inline constexpr std::string_view kMainProgram = "photohull-main";
/// Runs the commands that study the others.
inline constexpr std::string_view kLabProgram = "photohull-lab";

struct CommandEntry {
  std::string_view name, description, program;
  std::string_view lab_option = {};  ///< with it the lab's program runs the command
};

/// In the order of the help.
std::span<const CommandEntry> command_table();

/// The entry of that name, or nullptr.
const CommandEntry* find_command(std::string_view name);

/// Adds the table's command of that name, which it must have.
CLI::App* add_command(CLI::App& app, std::string_view name);

}  // namespace photohull::cli
