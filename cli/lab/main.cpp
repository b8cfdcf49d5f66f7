// photohull-lab: the commands that study the others.
#include "cli/lab/lab_commands.h"

int main(int argc, char** argv) {
  photohull::cli::handle_signals();
  return photohull::cli::run_command_line(argc, argv, photohull::cli::lab_commands());
}
