#include "io/photo_lens.h"

#include <cmath>

#include "core/error.h"
#include "io/open_image.h"

namespace photohull::io {
namespace {

/// Pixels to a millimetre of the sensor; 0: not stated, or in no unit.
double sensor_resolution(const OIIO::ImageSpec& spec) {
  const double pixels = double(spec.get_float_attribute("Exif:FocalPlaneXResolution", 0));
  const int unit = spec.get_int_attribute("Exif:FocalPlaneResolutionUnit", 2);
  const double millimetres = unit == 2 ? 25.4 : unit == 3 ? 10 : unit == 4 ? 1 : 0;
  if (!(pixels > 0) || millimetres == 0) return 0;
  // It is that of the picture as it was taken, which may have been scaled since.
  const int taken = spec.get_int_attribute("Exif:PixelXDimension", spec.width);
  return taken > 0 ? pixels / millimetres * spec.width / taken : 0;
}

double exposure_of(const OIIO::ImageSpec& spec) {
  const double seconds = double(spec.get_float_attribute("ExposureTime", 0)),
               stop = double(spec.get_float_attribute("FNumber", 0)),
               speed = double(
                   spec.get_int_attribute("Exif:PhotographicSensitivity",
                                          spec.get_int_attribute("Exif:ISOSpeedRatings", 0)));
  const double exposure = seconds / (stop * stop) * speed / 100;
  return seconds > 0 && stop > 0 && speed > 0 && std::isfinite(exposure) ? exposure : 0;
}

}  // namespace

PhotoLens read_photo_lens(const std::filesystem::path& path) {
  constexpr double kFilmDiagonal = 43.266615305567875;  // mm, of 36 x 24
  const OIIO::ImageSpec spec = open_image(path).spec;
  const double focal = double(spec.get_float_attribute("Exif:FocalLength", 0));
  const double film = double(spec.get_int_attribute("Exif:FocalLengthIn35mmFilm", 0));
  PhotoLens lens;
  const double diagonal = std::hypot(double(spec.width), double(spec.height));
  if (film > 0 && std::isfinite(film))
    lens.focal = film / kFilmDiagonal * diagonal;
  else if (focal > 0 && std::isfinite(focal))
    lens.focal = focal * sensor_resolution(spec);
  if (!(lens.focal > 0.1 * diagonal && lens.focal < 100 * diagonal)) lens.focal = 0;
  lens.exposure = exposure_of(spec);
  for (const char* field : {"Make", "Model"})
    if (const std::string word = one_line(std::string(spec.get_string_attribute(field)));
        !word.empty())
      lens.name += word + " ";
  if (focal > 0) lens.name += concat(focal, " mm ");
  lens.name += concat(spec.width, " x ", spec.height);
  return lens;
}

}  // namespace photohull::io
