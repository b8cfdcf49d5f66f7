// Which of the views that a scene lists have a photograph that fits their camera. Internal to io.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/image_file.h"
#include "io/raw_scene.h"

namespace photohull::io {

/// The photographs of a scene's views, as far as they exist.
struct Photographs {
  std::vector<std::filesystem::path> images;  ///< empty where there is no such file
  std::vector<std::string> names;  ///< file names where they tell all apart, else paths as listed
};

/// Looks for each view's image. A file that one view's path leads to serves no other view by its
/// name alone. Throws Error when two views mean the same image.
Photographs find_photographs(const RawScene& raw);

/// A view with its image and its completed camera, or why the image cannot be used.
struct CheckedView {
  std::optional<SourceView> view;
  LeftOutView left_out;  ///< where there is no view
  bool scaled = false;   ///< the camera was scaled to the image's size
};

/// The image's size is read from its header. Where the file states another one of which the image
/// is a scaled copy (core/scaled_size.h), the camera is scaled to the image. `pixel_center` as in
/// RawScene. Throws Error for a camera that is not finite.
CheckedView check_view(const RawScene& raw, std::size_t index, const Photographs& photographs,
                       double pixel_center);

/// The camera of an image of the size that the view's intrinsics state, which is not 0.
/// `pixel_center` as in RawScene. Throws Error for one that is not finite.
Camera complete_camera(const RawView& raw, double pixel_center);

/// Size of an image; zeros where it cannot be read.
ImageSize image_size_or_none(const std::filesystem::path& image);

}  // namespace photohull::io
