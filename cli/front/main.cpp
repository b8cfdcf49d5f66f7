// photohull: answers what needs no command, and hands the rest over to the program that runs the
// command (command_table.h). It starts at once, for it loads none of their libraries.
#include <algorithm>
#include <span>
#include <string_view>

#include "cli/front/command_line.h"
#include "cli/front/command_table.h"
#include "cli/front/flag_words.h"
#include "cli/front/programs.h"

namespace {

namespace cli = photohull::cli;

/// The program that the arguments need; empty: this one.
std::string_view program_for(std::span<char*> arguments) {
  const auto has = [&](std::string_view beginning) {
    return std::ranges::any_of(arguments,
                               [&](std::string_view word) { return word.starts_with(beginning); });
  };
  for (const char* word : arguments) {
    const cli::CommandEntry* entry = cli::find_command(word);
    if (!entry) continue;
    const bool in_lab = !entry->lab_option.empty() && has(entry->lab_option);
    return in_lab ? cli::kLabProgram : entry->program;
  }
  // The libraries and the device are the main program's.
  const bool all_of_version = has("--version") && has("--json") && !has("--help") && !has("-h");
  return all_of_version ? cli::kMainProgram : "";
}

void add_names(CLI::App& app) {
  for (const cli::CommandEntry& entry : cli::command_table()) cli::add_command(app, entry.name);
}

}  // namespace

int main(int argc, char** argv) {
  photohull::set_option_wording(cli::flag_wording());
  const std::string_view program = program_for({argv + std::min(argc, 1), argv + argc});
  if (!program.empty()) return cli::report_failures([&] { cli::become_program(program, argv); });
  cli::handle_signals();
  return cli::run_command_line(argc, argv, {add_names, nullptr});
}
