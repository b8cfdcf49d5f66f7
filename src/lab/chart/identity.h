// What makes two runs the same.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace photohull::chart {

/// XXH3's 128 bits of the contents, as 32 hexadecimal digits.
std::string hash_text(std::string_view text);
/// Throws Error when the file cannot be read.
std::string hash_file(const std::filesystem::path& file);
/// Of the names and contents of all files below a folder; independent of times and owners.
std::string hash_folder(const std::filesystem::path& folder);
/// Of a synthetic scene's spec and of the files that its texts name, relative to its folder.
std::string hash_spec(const std::filesystem::path& spec);

}  // namespace photohull::chart
