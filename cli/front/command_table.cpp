#include "cli/front/command_table.h"

#include <algorithm>
#include <string>

#include "core/error.h"

namespace photohull::cli {
namespace {

constexpr CommandEntry kCommands[] = {
    {"scan", "photographs to a textured model: pose and reconstruct in one", kMainProgram},
    {"reconstruct", "carve a volume and a mesh from photographs", kMainProgram},
    {"batch", "reconstruct many scenes or frames, by one process or by many", kMainProgram},
    {"plan", "write down what a batch is to make, for many processes", kMainProgram},
    {"run", "make what a plan has, as one of any number of processes", kMainProgram},
    {"status", "tell how far a plan is", kMainProgram},
    {"merge", "sum up what a plan's processes made", kMainProgram},
    {"submit", "have a cluster make a plan: Slurm, MPI or GNU parallel", kMainProgram},
    {"view", "open the page that reconstruct wrote in a browser", kMainProgram},
    {"render", "draw a result: a film of it turning, or stills", kMainProgram},
    {"measure", "volume, area, height and sizes of a result, with uncertainties", kMainProgram},
    {"info", "tell what was understood of a scene", kMainProgram},
    {"masks", "find the object in photographs, as reconstruct does", kMainProgram},
    {"convert", "write a scene's cameras for another program", kMainProgram},
    {"board", "make a sheet to print, on which the object stands", kMainProgram},
    {"pose", "find the cameras of photographs, on that sheet or by COLMAP", kMainProgram},
    {"calibrate", "find cameras' lenses and poses from photographs of a board", kMainProgram},
    {"refine-cameras", "make cameras that are slightly wrong fit the photographs", kMainProgram},
    {"synthesize", "make calibrated photographs of a surface that is known exactly", kMainProgram},
    {"evaluate", "measure a mesh by the exact surface or by photographs", kMainProgram,
     "--reliability-plot"},
    {"chart", "run a plan of reconstructions and draw speed against accuracy", kLabProgram},
    {"stress", "degrade synthetic scenes step by step and see where reconstruction breaks",
     kLabProgram},
    {"bench", "measure parts of the program by themselves", kLabProgram},
    {"devices", "list the EGL devices and which one 'auto' takes", kMainProgram},
    {"doctor", "tell of this machine what a report of a fault needs, and test it", kMainProgram},
    {"demo", "reconstruct the temple from photographs that come with the program", kMainProgram},
};

}  // namespace

std::span<const CommandEntry> command_table() { return kCommands; }

const CommandEntry* find_command(std::string_view name) {
  const auto found = std::ranges::find(kCommands, name, &CommandEntry::name);
  return found == std::end(kCommands) ? nullptr : found;
}

CLI::App* add_command(CLI::App& app, std::string_view name) {
  const CommandEntry* entry = find_command(name);
  PHOTOHULL_CHECK(entry != nullptr);
  return app.add_subcommand(std::string(entry->name), std::string(entry->description));
}

}  // namespace photohull::cli
