// The programs that lie in one folder: photohull, and those that run its commands.
#pragma once

#include <filesystem>
#include <string_view>

namespace photohull::cli {

/// The program of that name in the folder of the one that runs.
std::filesystem::path program_beside(std::string_view name);

/// Becomes that program, with this one's arguments. Returns only by throwing Error: it is not there
/// or cannot be started.
[[noreturn]] void become_program(std::string_view name, char** argv);

}  // namespace photohull::cli
