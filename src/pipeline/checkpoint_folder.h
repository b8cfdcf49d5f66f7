// Where a refinement keeps the levels that are done.
#pragma once

#include <filesystem>

namespace photohull::pipeline {

std::filesystem::path checkpoint_file(const std::filesystem::path& folder);
/// What cannot be removed belongs to another job, or to this one anew.
void remove_checkpoint(const std::filesystem::path& folder);

}  // namespace photohull::pipeline
