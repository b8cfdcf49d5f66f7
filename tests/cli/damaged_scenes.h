// Mistakes that people make with scenes, by name: each spoils a folder with a sound scene in it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace photohull::test {

/// A sound scene of 12 photographs of 160 x 120 pixels as `photohull synthesize` makes it, and what
/// differs from that: a JSON merge patch of its spec. Made once by every process that asks for it.
const std::filesystem::path& sound_scene(const nlohmann::json& patch);

/// The files below a folder that a pattern such as "scene/images/*.png" names, sorted, or the one
/// path that it is without a star. Throws std::runtime_error when a pattern names none.
std::vector<std::filesystem::path> files_named(const std::filesystem::path& folder,
                                               const std::string& pattern);

/// Makes a mistake in a folder: its name and what it needs, as in ["remove", "scene/images/0.png"].
/// Throws std::runtime_error for a name that is not known.
void damage(const std::filesystem::path& folder, const nlohmann::json& mistake);

}  // namespace photohull::test
