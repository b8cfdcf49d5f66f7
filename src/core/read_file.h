// Files read whole.
#pragma once

#include <filesystem>
#include <string>

namespace photohull {

/// All bytes of a regular file. Throws Error that names the file when it is none, when it cannot be
/// opened, and when reading fails or ends before its size is reached: half a file is never taken
/// for a whole one.
std::string read_whole_file(const std::filesystem::path& path);

}  // namespace photohull
