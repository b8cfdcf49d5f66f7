// photohull bench visibility.
#pragma once

#include <CLI/CLI.hpp>

namespace photohull::cli {

/// Adds `visibility` to the commands of `bench`.
void add_bench_visibility(CLI::App& bench);

}  // namespace photohull::cli
