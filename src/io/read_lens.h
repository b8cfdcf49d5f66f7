// The lens of a camera that was calibrated before.
#pragma once

#include <filesystem>
#include <string>

#include "core/camera.h"

namespace photohull::io {

struct CameraLens {
  Intrinsics intrinsics;  ///< pixel centres at (0, 0)
  Distortion distortion;
};

/// What a file of `photohull calibrate` or a scene (any SceneFormat; photographs need not be there)
/// says of its lens, for pictures of width x height pixels: scaled where they are a scaled copy of
/// those that it is for. `camera`: that camera's of a rig's file; of all others it does not count.
/// Throws Error where there is no such file or camera, where a scene has several lenses, and for
/// pictures of another shape.
CameraLens read_lens(const std::filesystem::path& file, int width, int height,
                     const std::string& camera = {});

}  // namespace photohull::io
