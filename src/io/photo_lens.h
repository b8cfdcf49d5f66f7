// What a photograph's file says of the lens that took it.
#pragma once

#include <filesystem>
#include <string>

#include "core/describe.h"

namespace photohull::io {

/// A focal length to start from, for photographs whose files state none. At most one is not 0.
struct FocalOptions {
  double pixels = 0;
  double film = 0;  ///< mm, for 35 mm film: that with the same angle across the diagonal

  bool given() const { return pixels > 0 || film > 0; }
};

void describe(Described& to, FocalOptions& options);

struct PhotoLens {
  /// Maker, model, focal length in millimetres and size in pixels, as far as they are stated, in
  /// one line: photographs in which it differs were taken with another lens or zoom.
  std::string name;
  double focal = 0;     ///< pixels; 0: not stated
  bool given = false;   ///< the focal length is that of the options
  double exposure = 0;  ///< that the camera chose, seconds at f/1 and ISO 100; 0: not stated
};

/// By its EXIF data: the focal length for 35 mm film (of a diagonal of 43.27 mm), or in millimetres
/// with the sensor's resolution; or else by the options. Nothing is decoded. Throws Error as
/// read_image_size does, UsageError where the given focal length is no camera's (a field of view
/// below half a degree or above 157 degrees).
PhotoLens read_photo_lens(const std::filesystem::path& path, const FocalOptions& given = {});

}  // namespace photohull::io
