// Pairs masks with images. Internal to io.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/load_scene.h"
#include "io/raw_scene.h"

namespace photohull::io {

/// The mask in a folder for an image listed as `listed` ("cam1/0001.jpg"); empty when there is
/// none.
std::filesystem::path find_mask(const std::filesystem::path& folder,
                                const std::filesystem::path& image, const std::string& listed);

/// Sets the mask of every view as the options ask; `raw[i]` is what the scene file said of
/// `scene.views[i]`. Checks that each mask has its image's size. Views that a folder holds no mask
/// for are counted and named in the scene's warnings; LoadSceneOptions::strict refuses them.
/// Throws Error naming the view and where its mask was looked for: where a mask that the scene file
/// names is not there, and where a folder that was asked for holds none at all.
void attach_masks(const LoadSceneOptions& options, const std::filesystem::path& scene_folder,
                  const std::vector<RawView>& raw, Scene& scene);

/// Sets the plate of every view from LoadSceneOptions::background, where that is given. Throws
/// Error naming the view when its plate is missing, cannot be read or has another size.
void attach_plates(const LoadSceneOptions& options, const std::vector<RawView>& raw, Scene& scene);

}  // namespace photohull::io
