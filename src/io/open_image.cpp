#include "io/open_image.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <mutex>

#include "core/error.h"
#include "io/check_png.h"
#include "io/image_file.h"
#include "io/image_signature.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

Layout layout_of(const OIIO::ImageSpec& spec, const fs::path& path) {
  constexpr int kMaxChannels = 16;
  Layout layout;
  layout.alpha = spec.alpha_channel;
  const int before_alpha = layout.alpha >= 0 ? layout.alpha : spec.nchannels;
  layout.colours = before_alpha >= 3 ? 3 : 1;
  layout.channels = std::max(layout.colours, layout.alpha + 1);
  if (layout.alpha == 0 || layout.channels > kMaxChannels)
    throw Error(concat(path.string(), ": ", spec.nchannels, " channels with alpha at number ",
                       layout.alpha, " are no grey or RGB image; save it as grey, RGB or RGBA"));
  layout.premultiplied =
      layout.alpha >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
  return layout;
}

void check_size(const OIIO::ImageSpec& spec, const fs::path& path) {
  if (spec.width <= 0 || spec.height <= 0 || spec.depth > 1 ||
      std::int64_t(spec.width) * spec.height > kMaxImagePixels)
    throw Error(concat(path.string(), ": the image claims ", spec.width, " x ", spec.height, " x ",
                       std::max(spec.depth, 1), " pixels, but at most ", kMaxImagePixels,
                       " in one plane can be read; scale it down"));
}

}  // namespace

void keep_to_one_thread() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
  });
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

OpenImage open_image(const fs::path& path) {
  keep_to_one_thread();
  if (!is_file(path)) throw Error(concat(path.string(), ": there is no such image file"));
  OpenImage file;
  file.path = path;
  OIIO::ImageSpec request;
  request.attribute("oiio:UnassociatedAlpha", 1);
  file.input = OIIO::ImageInput::create(image_format(path));
  if (!file.input || !file.input->open(path.string(), file.spec, request))
    throw Error(concat(path.string(), ": cannot be read as an image (",
                       one_line(file.input ? file.input->geterror() : OIIO::geterror()), "); ",
                       known_images()));
  file.input->threads(1);
  check_size(file.spec, path);
  const OIIO::ImageSpec& s = file.spec;
  if (std::strcmp(file.input->format_name(), "openexr") == 0 &&
      (s.x != s.full_x || s.y != s.full_y || s.width != s.full_width || s.height != s.full_height))
    throw Error(concat(path.string(), ": the data window (", s.width, " x ", s.height,
                       ") is not the display window (", s.full_width, " x ", s.full_height,
                       "); save the image uncropped"));
  file.layout = layout_of(file.spec, path);
  return file;
}

OpenImage open_whole_image(const fs::path& path) {
  OpenImage file = open_image(path);
  if (std::strcmp(file.input->format_name(), "png") == 0) check_png(path);
  return file;
}

std::uint32_t unpremultiplied(std::uint32_t colour, std::uint32_t alpha, std::uint32_t maximum) {
  if (alpha == 0) return colour;
  return std::uint32_t(
      std::min<std::uint64_t>(maximum, (std::uint64_t(colour) * maximum + alpha / 2) / alpha));
}

void damaged(const OpenImage& file, const std::string& detail) {
  throw Error(concat(file.path.string(), ": the image is damaged or cut short (", one_line(detail),
                     "); export it again"));
}

void unsupported(const OpenImage& file) {
  throw Error(concat(file.path.string(), ": pixels of type ", file.spec.format.c_str(),
                     " are not supported; save it with 8 or 16 bits, half or float"));
}

bool declares_linear(const OIIO::ImageSpec& spec) {
  std::string space(spec.get_string_attribute("oiio:ColorSpace"));
  std::transform(space.begin(), space.end(), space.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return space.starts_with("lin") || space == "scene_linear" || space == "acescg";
}

float finite_or_zero(float value) { return std::isfinite(value) ? value : 0.0f; }

std::uint8_t luminance(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return std::uint8_t((54u * r + 183u * g + 19u * b + 128u) >> 8);
}

void out_of_memory(const OpenImage& file) {
  throw MemoryError(concat(file.path.string(), ": there is not enough memory for ", file.spec.width,
                           " x ", file.spec.height, " pixels; scale the image down"));
}

}  // namespace photohull::io
