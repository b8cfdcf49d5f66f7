// What OpenEXR's library believes in a file without looking. Internal to io.
#pragma once

#include <filesystem>

namespace photohull::io {

/// Throws Error naming the file unless each attribute of its header has the size of its type and
/// fits the bytes that are there: the library asks for whatever memory they claim. Format: "OpenEXR
/// File Layout".
void check_openexr(const std::filesystem::path& path);

}  // namespace photohull::io
