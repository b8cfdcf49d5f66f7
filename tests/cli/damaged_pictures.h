// Mistakes with photographs and masks, by name.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace photohull::test {

/// Makes a mistake in the picture files that its second element names (files_named); false when the
/// first is no mistake with pictures.
bool damage_pictures(const std::filesystem::path& folder, const nlohmann::json& mistake);

}  // namespace photohull::test
