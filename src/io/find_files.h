// Files of scenes by patterns of their names. Internal to io.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace photohull::io {

/// The regular files directly in a folder whose names end so, in natural order (2 before 10);
/// none when there is no such folder.
std::vector<std::filesystem::path> files_ending(const std::filesystem::path& folder,
                                                std::string_view ending);

/// The only such file, or empty when there is none. Throws Error naming two of them where there
/// are several.
std::filesystem::path only_file_ending(const std::filesystem::path& folder,
                                       std::string_view ending);

/// The images of a folder, in natural order.
std::vector<std::filesystem::path> images_in(const std::filesystem::path& folder);

/// The file that a listed name means, with or without an extension, relative to one of the
/// folders. Empty when there is none.
std::filesystem::path find_listed_image(const std::string& listed,
                                        const std::vector<std::filesystem::path>& folders);

/// What is left of a path of another machine (C:\scans\images\1.png) without its first folders:
/// all of it, then ever less down to the name alone, with slashes.
std::vector<std::string> shorter_paths(const std::string& listed);

/// The same as find_listed_image; else, since files name paths of other machines, what the first of
/// the shorter paths means that is there. Empty when it is nowhere.
std::filesystem::path find_image(const std::string& listed,
                                 const std::vector<std::filesystem::path>& folders);

/// The first bytes of a file (fewer where it is shorter, none where it cannot be read).
std::string file_head(const std::filesystem::path& file, std::size_t bytes = 4096);

/// The folder that holds a file; "." for a bare name.
std::filesystem::path folder_of(const std::filesystem::path& file);

}  // namespace photohull::io
