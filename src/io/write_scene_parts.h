// What the writers of the scene formats share. Internal to io.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
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

/// Throws Error naming view and format: it has no such distortion.
[[noreturn]] void refuse_distortion(const SourceView& view, const char* format);

/// Throws Error naming view and format unless the camera has no distortion.
void require_pinhole(const SourceView& view, const char* format);

/// Throw Error naming view and format unless pixels are square, and unless the principal point is
/// the image's centre.
void require_square_pixels(const SourceView& view, const char* format);
void require_centred(const SourceView& view, const char* format);

/// Elements row by row, with blanks between them; the same with a line for each row; and a
/// vector's.
std::string matrix_text(const glm::dmat3& matrix);
std::string matrix_lines(const glm::dmat3& matrix);
std::string vector_text(const glm::dvec3& vector);

/// "00000012"
std::string numbered_name(std::size_t index);

/// Copies the view's image into a folder under a name to which its own extension is added, unless
/// it lies there already. Returns the file's name. Throws Error when that fails.
std::string place_image(const SourceView& view, const std::filesystem::path& folder,
                        const std::string& stem);

/// JSON, indented; names that are not UTF-8 could not be read back, but do not end in an exception.
std::string json_text(const nlohmann::ordered_json& root);

/// Writes bbox.txt where the scene has a box.
void write_bbox_file(const Scene& scene, const std::filesystem::path& folder);

}  // namespace photohull::io
