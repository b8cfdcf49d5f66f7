// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace photohull::io {

/// Calls `write` with a temporary path in the folder of `path`, then renames it to `path`: readers
/// see the old file or the complete new one. When `write` throws, nothing is left behind and the
/// exception goes on. Throws Error when the file cannot be put in place.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path&)>& write);

/// The same for contents at hand.
void write_atomically(const std::filesystem::path& path, std::string_view contents);

}  // namespace photohull::io
