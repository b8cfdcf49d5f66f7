// Which file of a folder is the scene. Internal to io.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"

namespace photohull::io {

struct SceneLocation {
  SceneFormat format = SceneFormat::kMiddlebury;
  std::filesystem::path file;         ///< par file, JSON file, or the folder of a COLMAP model
  std::vector<std::string> warnings;  ///< what else lies there and was passed over
};

/// Finds the scene in a folder, or recognises the file given. Where a folder holds several formats
/// the order is that of format_entries(), with a warning. Throws Error listing what was
/// looked for when there is none, or several par files.
SceneLocation find_scene(const std::filesystem::path& path, std::optional<SceneFormat> format);

}  // namespace photohull::io
