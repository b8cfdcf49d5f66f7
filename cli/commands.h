// The subcommands: each adds its arguments to the parser and runs when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace photohull::cli {

void add_reconstruct(CLI::App& app);
/// Are these, between SCENE and --out, arguments that 'photohull reconstruct' takes together?
/// Throws UsageError, which says what is wrong.
void check_reconstruct(const std::vector<std::string>& arguments);
void add_evaluate(CLI::App& app);
void add_convert(CLI::App& app);
void add_refine_cameras(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_masks(CLI::App& app);
void add_info(CLI::App& app);
void add_synthesize(CLI::App& app);
void add_chart(CLI::App& app);
void add_stress(CLI::App& app);
void add_bench(CLI::App& app);
void add_devices(CLI::App& app);

}  // namespace photohull::cli
