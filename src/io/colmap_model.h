// What the text and the binary reader of COLMAP models share. Internal to io.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "io/raw_scene.h"

namespace photohull::io {

/// A camera of the model: intrinsics in COLMAP's pixels, where the top-left centre is (0.5, 0.5).
struct ColmapCamera {
  Intrinsics intrinsics;
  Distortion distortion;
};

using ColmapCameras = std::map<std::uint32_t, ColmapCamera>;

/// A lens model that photohull can express.
struct ColmapLens {
  const char* name = "";
  int id = 0;  ///< in binary files
  int parameters = 0;
  bool one_focal = false;  ///< f, cx, cy instead of fx, fy, cx, cy
  DistortionModel distortion = DistortionModel::kNone;
};

/// Throws Error opening with `where` and naming the model when it is unknown.
const ColmapLens& colmap_lens(std::string_view name, const std::string& where);
const ColmapLens& colmap_lens(int id, const std::string& where);

/// `parameters` as many as the lens has, in COLMAP's order. Throws Error opening with `where` when
/// width or height do not fit an image.
ColmapCamera make_colmap_camera(const ColmapLens& lens, std::uint64_t width, std::uint64_t height,
                                std::span<const double> parameters, const std::string& where);

/// A view from an image entry: quaternion w x y z and translation, world to camera. Throws Error
/// opening with `where` when the camera is unknown, the name empty or the quaternion far from
/// unit length.
RawView make_colmap_view(std::string name, std::span<const double, 4> quaternion,
                         const glm::dvec3& translation, std::uint32_t camera_id,
                         const ColmapCameras& cameras, const std::string& where);

/// An empty model of a folder: format, pixel convention and where its images are looked for.
RawScene begin_colmap_scene(const std::filesystem::path& folder, SceneFormat format);

}  // namespace photohull::io
