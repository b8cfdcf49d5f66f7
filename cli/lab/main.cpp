// photohull-lab: the commands that study the others.
#include "cli/front/flag_words.h"
#include "cli/lab/lab_commands.h"

int main(int argc, char** argv) {
  photohull::set_option_wording(photohull::cli::flag_wording());
  photohull::cli::handle_signals();
  return photohull::cli::run_command_line(argc, argv, photohull::cli::lab_commands());
}
