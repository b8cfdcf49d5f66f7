// The subcommands that study the others.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/front/command_line.h"

namespace photohull::cli {

void add_chart(CLI::App& app);
void add_stress(CLI::App& app);
void add_bench(CLI::App& app);

/// All of these, and the command evaluate with diagrams of reliability.
Commands lab_commands();

}  // namespace photohull::cli
