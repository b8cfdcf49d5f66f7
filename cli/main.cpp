// photohull-main: the commands but those of the lab.
#include <glog/logging.h>

#include "cli/front/flag_words.h"
#include "commands.h"
#include "photo/opencv_threads.h"

int main(int argc, char** argv) {
  photohull::set_option_wording(photohull::cli::flag_wording());
  // Ceres notes there what its summaries tell as well; users get a sentence instead.
  FLAGS_minloglevel = google::GLOG_FATAL;
  const photohull::OneOpenCvThread one_thread;
  photohull::cli::handle_signals();
  return photohull::cli::run_command_line(argc, argv, photohull::cli::main_commands());
}
