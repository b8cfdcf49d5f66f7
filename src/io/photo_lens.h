// What a photograph's file says of the lens that took it.
#pragma once

#include <filesystem>
#include <string>

namespace photohull::io {

struct PhotoLens {
  /// Maker, model, focal length in millimetres and size in pixels, as far as they are stated, in
  /// one line: photographs in which it differs were taken with another lens or zoom.
  std::string name;
  double focal = 0;     ///< pixels; 0: not stated
  double exposure = 0;  ///< that the camera chose, seconds at f/1 and ISO 100; 0: not stated
};

/// By its EXIF data: the focal length for 35 mm film (of a diagonal of 43.27 mm), or in millimetres
/// with the sensor's resolution. Nothing is decoded. Throws Error as read_image_size does.
PhotoLens read_photo_lens(const std::filesystem::path& path);

}  // namespace photohull::io
