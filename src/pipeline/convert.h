// A scene to another program's format.
#pragma once

#include <filesystem>

#include "core/progress.h"
#include "core/scene.h"

namespace photohull::pipeline {

/// Photographs and masks resampled once to pinhole cameras without skew, with square pixels and
/// the principal point in the middle (views/undistort.h, rectify), written as 8-bit sRGB PNG to
/// `folder`/images and `folder`/masks: what any format can express. Pixels that a photograph does
/// not show are transparent in the picture and object in the mask. Returns the scene with these
/// images and cameras. Throws Error, Cancelled.
Scene undistort_scene(const Scene& scene, const std::filesystem::path& folder, Progress& progress);

}  // namespace photohull::pipeline
