#include "io/decode_picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <memory>

#include "core/error.h"
#include "io/image_file.h"
#include "io/open_image.h"

namespace photohull::io {
namespace {

constexpr std::array<std::uint8_t, 4> kPng = {0x89, 'P', 'N', 'G'};
constexpr std::array<std::uint8_t, 3> kJpeg = {0xff, 0xd8, 0xff};

template <typename Beginning>
bool begins_with(std::span<const std::uint8_t> bytes, const Beginning& beginning) {
  return bytes.size() > beginning.size() &&
         std::equal(beginning.begin(), beginning.end(), bytes.begin());
}

}  // namespace

RgbImage decode_picture(std::span<const std::uint8_t> bytes, const std::string& name) {
  const bool png = begins_with(bytes, kPng);
  if (!png && !begins_with(bytes, kJpeg)) throw Error(name + ": neither PNG nor JPEG");
  keep_to_one_thread();
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::open(png ? "picture.png" : "picture.jpg", nullptr, &memory);
  if (!input) throw Error(concat(name, ": damaged (", one_line(OIIO::geterror()), ")"));
  const OIIO::ImageSpec spec = input->spec();
  if (spec.format != OIIO::TypeDesc::UINT8 || spec.width < 1 || spec.height < 1 ||
      std::int64_t(spec.width) * spec.height > kMaxImagePixels)
    throw Error(concat(name, ": ", spec.width, "x", spec.height, " pixels of type ",
                       spec.format.c_str(), ", which is not read"));
  const auto channels = std::size_t(spec.nchannels);
  const std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
  std::vector<std::uint8_t> read(pixels * channels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, read.data()))
    throw Error(concat(name, ": damaged (", one_line(input->geterror()), ")"));
  RgbImage out{spec.width, spec.height, {}};
  out.rgb.reserve(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.rgb.push_back(read[i * channels + (channels < 3 ? 0 : c)]);
  return out;
}

}  // namespace photohull::io
