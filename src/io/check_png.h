// What libpng says on standard error by itself before it gives up. Internal to io.
#pragma once

#include <filesystem>

namespace photohull::io {

/// Throws Error naming the file where it ends before the chunk IEND: it was cut short. Reads the
/// heads of the chunks only. Format: PNG specification, section 5.
void check_png(const std::filesystem::path& path);

}  // namespace photohull::io
