// What the writers of the scene formats share. Internal to io.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include "core/scene.h"

namespace photohull::io {

/// The shortest decimal number that reads back to the same double, whatever the locale.
std::string number_text(double value);

/// The view's name where one of `image_folders` (relative to `folder`) holds its image by that
/// name, else the path of its image relative to `folder`; generic, with forward slashes.
std::string listed_name(const SourceView& view, const std::filesystem::path& folder,
                        std::initializer_list<const char*> image_folders);

/// A path relative to a folder, with forward slashes.
std::string relative_path(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Makes the folder and its parents. Throws Error when that fails.
void make_folder(const std::filesystem::path& folder);

/// Throws Error naming view and format unless the camera has no skew.
void require_no_skew(const SourceView& view, const char* format);

/// Writes bbox.txt where the scene has a box.
void write_bbox_file(const Scene& scene, const std::filesystem::path& folder);

}  // namespace photohull::io
