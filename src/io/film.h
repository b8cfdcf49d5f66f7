// Pictures one after another, as files of pictures or as a film.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/progress.h"
#include "core/rgb_image.h"

namespace photohull::io {

struct FilmFormat {
  int width = 0, height = 0;  ///< pixels
  int pictures = 0;           ///< that will be added
  double rate = 30;           ///< pictures a second
};

/// Takes the pictures of a film. What was not finished leaves nothing behind: a film of that name
/// stays as it was, and pictures in files of their own, which replace others one by one, go again.
class Film {
 public:
  virtual ~Film() = default;
  /// Throws Error where it cannot be written, and Cancelled.
  virtual void add(const RgbImage& picture) = 0;
  /// To be called once, after the last picture.
  virtual void finish() = 0;
};

/// A film by its name:
///
///   NAME.mp4 .mov .mkv .webm   H.264, of .webm VP9, by the program ffmpeg
///   NAME.gif .webp             a moving picture for pages, which starts anew at its end, the same
///   NAME_%04d.png              a PNG file for each picture, counted from 0
///   FOLDER                     (without extension) frame_0000.png, ... in it; made if need be
///
/// The same pictures give the same bytes. Throws UsageError, which names the option `turntable`,
/// for other names, and sizes that a film cannot have; Error where ffmpeg is not installed or does
/// not do it, and where files cannot be written.
std::unique_ptr<Film> open_film(const std::string& name, const FilmFormat& format,
                                const Progress& progress);

}  // namespace photohull::io
