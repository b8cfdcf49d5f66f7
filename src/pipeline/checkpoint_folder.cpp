#include "pipeline/checkpoint_folder.h"

#include <system_error>

namespace photohull::pipeline {

std::filesystem::path checkpoint_file(const std::filesystem::path& folder) {
  return folder / ".photohull-checkpoint";
}

void remove_checkpoint(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(checkpoint_file(folder), ignored);
}

}  // namespace photohull::pipeline
