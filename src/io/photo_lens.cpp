#include "io/photo_lens.h"

#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "core/option_word.h"
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

constexpr double kFilmDiagonal = 43.266615305567875;  // mm, of 36 x 24
constexpr double kShortest = 0.1, kLongest = 100;     // focal lengths, of the diagonal

bool is_possible(double focal, double diagonal) {
  return focal > kShortest * diagonal && focal < kLongest * diagonal;
}

std::string text_of_focal(const FocalOptions& o) {
  return o.film > 0 ? concat(o.film, "mm") : o.pixels > 0 ? concat(o.pixels) : std::string();
}

bool read_focal(const std::string& text, FocalOptions& o) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || !(value > 0) || !std::isfinite(value)) return false;
  const std::string unit = end;
  const bool film = unit == "mm" || unit == " mm";
  if (!film && !unit.empty()) return false;
  if (film && !is_possible(value, kFilmDiagonal)) return false;
  o = film ? FocalOptions{0, value} : FocalOptions{value, 0};
  return true;
}

/// In pixels of a photograph.
double given_focal(const FocalOptions& o, const OIIO::ImageSpec& spec,
                   const std::filesystem::path& path) {
  const double diagonal = std::hypot(double(spec.width), double(spec.height));
  const double focal = o.film > 0 ? o.film / kFilmDiagonal * diagonal : o.pixels;
  if (!o.given() || is_possible(focal, diagonal)) return focal;
  const double angle = 2 * std::atan(0.5 * diagonal / focal) * 180 / M_PI;
  throw UsageError(concat(option_word("focal", text_of_focal(o)), ": in ", path.filename().string(),
                          ", of ", spec.width, " x ", spec.height,
                          " pixels, it is a field of view of ", std::round(100 * angle) / 100,
                          " degrees across the diagonal; give it between ",
                          std::ceil(kShortest * diagonal), " and ", std::floor(kLongest * diagonal),
                          " pixels of that photograph, or for 35 mm film, such as 28mm"));
}

}  // namespace

void describe(Described& to, FocalOptions& o) {
  to.text("focal",
          Words{[&o] { return text_of_focal(o); },
                [&o](const std::string& text) { return read_focal(text, o); }},
          "focal length to start from where photographs state none in their EXIF data")
      .expects = "pixels above 0, such as 3000, or millimetres for 35 mm film, such as 28mm";
}

PhotoLens read_photo_lens(const std::filesystem::path& path, const FocalOptions& given) {
  const OIIO::ImageSpec spec = open_image(path).spec;
  const double focal = double(spec.get_float_attribute("Exif:FocalLength", 0));
  const double film = double(spec.get_int_attribute("Exif:FocalLengthIn35mmFilm", 0));
  PhotoLens lens;
  const double diagonal = std::hypot(double(spec.width), double(spec.height));
  if (film > 0 && std::isfinite(film))
    lens.focal = film / kFilmDiagonal * diagonal;
  else if (focal > 0 && std::isfinite(focal))
    lens.focal = focal * sensor_resolution(spec);
  if (!is_possible(lens.focal, diagonal)) {
    lens.focal = given_focal(given, spec, path);
    lens.given = given.given();
  }
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
