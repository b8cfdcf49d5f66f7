// What is wrong with a command line, in one sentence.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace photohull::cli {

/// The names of an app's commands, such as "reconstruct".
std::vector<std::string> command_names(const CLI::App& app);

/// The sentence for what the parser found wrong. Commands and options that do not exist come
/// first, for what is missing may be one of them misspelt; with the name that may have been meant.
std::string parse_fault(const CLI::App& app, const CLI::ParseError& error);

}  // namespace photohull::cli
