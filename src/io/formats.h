// The scene formats: how each is recognised, read and written. Internal to io.
#pragma once

#include <filesystem>
#include <span>

#include "io/raw_scene.h"

namespace photohull::io {

struct FormatEntry {
  SceneFormat format = SceneFormat::kMiddlebury;
  const char* looked_for = "";  ///< in a folder, for error messages
  /// The file (or, of formats with a file a view, the folder) that a folder's scene is read from;
  /// empty when there is none.
  std::filesystem::path (*find)(const std::filesystem::path& folder) = nullptr;
  /// Is a file one of this format's, by its name and where that does not tell by its beginning?
  bool (*recognises)(const std::filesystem::path& file) = nullptr;
  /// The format is read from the folder that holds the file.
  bool reads_folder = false;
  RawScene (*read)(const std::filesystem::path& path) = nullptr;
  void (*write)(const Scene& scene, const std::filesystem::path& folder) = nullptr;
  /// Of formats whose cameras need the photographs: `read` with these in another folder.
  RawScene (*read_with)(const std::filesystem::path& path,
                        const std::filesystem::path& images) = nullptr;
};

/// All formats, those that take precedence in a folder first.
std::span<const FormatEntry> format_entries();
const FormatEntry& format_entry(SceneFormat format);

/// Reads what find_scene found. `images`: where its photographs are instead of where the format has
/// them; empty: there.
RawScene read_raw_scene(SceneFormat format, const std::filesystem::path& file,
                        const std::filesystem::path& images);

}  // namespace photohull::io
