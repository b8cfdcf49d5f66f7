// The subcommands: each adds its arguments to the parser and runs when it was chosen. Those of the
// lab are in lab/lab_commands.h.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/front/command_line.h"

namespace photohull::eval {
struct Reliability;
}

namespace photohull::cli {

void add_reconstruct(CLI::App& app);
/// Are these, between SCENE and --out, arguments that 'photohull reconstruct' takes together?
/// Throws UsageError, which says what is wrong.
void check_reconstruct(const std::vector<std::string>& arguments);
/// A diagram, as a PNG or SVG file has it, of the reliability of the mesh of that name.
using DrawReliability = std::string (*)(const std::string& mesh, const eval::Reliability&,
                                        bool as_svg);
/// `draw`: nullptr where --reliability-plot is not to be had.
void add_evaluate(CLI::App& app, DrawReliability draw);
/// Many reconstructions.
void add_batch(CLI::App& app);
/// The same in parts, for many processes.
void add_plan(CLI::App& app);
void add_run(CLI::App& app);
void add_status(CLI::App& app);
void add_merge(CLI::App& app);
void add_submit(CLI::App& app);
void add_convert(CLI::App& app);
void add_refine_cameras(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_board(CLI::App& app);
void add_pose(CLI::App& app);
void add_scan(CLI::App& app);
void add_masks(CLI::App& app);
void add_info(CLI::App& app);
void add_synthesize(CLI::App& app);
void add_devices(CLI::App& app);
void add_view(CLI::App& app);
void add_render(CLI::App& app);
void add_measure(CLI::App& app);
void add_doctor(CLI::App& app);
void add_demo(CLI::App& app);

/// All of these.
Commands main_commands();

}  // namespace photohull::cli
