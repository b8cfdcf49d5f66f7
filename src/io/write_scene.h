// Scenes to the files of other programs: cameras, box and sparse points. Images are not copied but
// where a format finds them by place or number: PMVS, MVSNet, MVE and Strecha's.
#pragma once

#include <filesystem>
#include <vector>

#include "core/scene.h"

namespace photohull::io {

/// Each writes into a folder, made if need be, what load_scene reads back to the same cameras, to
/// rounding, in the format's own axes and pixel convention. A view is written under its name where
/// the reader would find its image by that, and under the path of its image relative to the
/// folder otherwise. The box goes to bbox.txt (write_transforms: to "aabb").
///
/// Throws Error when the folder cannot be written or the format cannot express a camera; `what`
/// says which view and why.

void write_scene(const Scene& scene, SceneFormat format, const std::filesystem::path& folder);

/// All formats, in the order in which a folder is searched for them.
std::vector<SceneFormat> scene_formats();

/// scene_par.txt, images looked for in `folder` and images/. No distortion.
void write_middlebury(const Scene& scene, const std::filesystem::path& folder);

/// cameras, images and points3D of a sparse model, without observations; images looked for as
/// load_scene says. No skew.
void write_colmap_text(const Scene& scene, const std::filesystem::path& folder);
void write_colmap_binary(const Scene& scene, const std::filesystem::path& folder);

/// transforms.json with masks, and beside it points.ply where the scene has points. No skew; no
/// distortion of measured points.
void write_transforms(const Scene& scene, const std::filesystem::path& folder);

}  // namespace photohull::io
