#include "io/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/half.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/open_image.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr float kHalfMax = 65504.0f;

/// Reads the layout's channels of every pixel, interleaved, converted to `type`.
void read_pixels(OpenImage& file, OIIO::TypeDesc type, void* out) {
  // Warnings of the decoders (a JPEG cut short) come as an error text after an apparent success.
  const bool read = file.input->read_image(0, 0, 0, file.layout.channels, type, out);
  if (!read || file.input->has_error()) damaged(file, file.input->geterror());
}

ColourImage decode_8bit(OpenImage& file, ColourImage image) {
  const Layout layout = file.layout;
  const std::size_t pixels = file.pixels();
  const int n = layout.channels;
  image.encoding = ColourImage::Encoding::kSrgb8;
  image.bytes.resize(pixels * std::max(4, n));
  // The file's values go to the end of the buffer and spread towards its start: pixel i is read
  // before anything is written on it, so no second buffer is needed.
  std::uint8_t* out = image.bytes.data();
  const std::uint8_t* in = n < 4 ? out + pixels * (4 - n) : out;
  read_pixels(file, OIIO::TypeDesc::UINT8, const_cast<std::uint8_t*>(in));
  const int g = layout.colours == 3 ? 1 : 0, b = layout.colours == 3 ? 2 : 0;
  if (layout.alpha < 0) {
    for (std::size_t i = 0; i < pixels; ++i, in += n, out += 4) {
      const std::uint8_t pixel[4] = {in[0], in[g], in[b], 255};
      std::memcpy(out, pixel, 4);
    }
  } else if (n != 4 || layout.colours != 3 || layout.premultiplied) {
    for (std::size_t i = 0; i < pixels; ++i, in += n, out += 4) {
      std::uint8_t pixel[4] = {in[0], in[g], in[b], in[layout.alpha]};
      if (layout.premultiplied)
        for (int c = 0; c < 3; ++c)
          pixel[c] = std::uint8_t(unpremultiplied(pixel[c], pixel[3], 255));
      std::memcpy(out, pixel, 4);
    }
  }
  image.bytes.resize(pixels * 4);
  return image;
}

std::uint16_t half_bits(double value) { return half(float(value)).bits(); }

/// Half-float bits of every 16-bit value.
using HalfTable = std::array<std::uint16_t, 65536>;

const HalfTable& half_from_16bit(bool srgb) {
  static const auto build = [](bool decode) {
    auto table = std::make_unique<HalfTable>();
    for (int i = 0; i < 65536; ++i)
      (*table)[i] = half_bits(decode ? linear_from_srgb(i / 65535.0) : i / 65535.0);
    return table;
  };
  static const auto linear_table = build(false);
  static const auto srgb_table = build(true);
  return srgb ? *srgb_table : *linear_table;
}

ColourImage decode_16bit(OpenImage& file, ColourImage image) {
  const Layout layout = file.layout;
  const std::size_t pixels = file.pixels();
  const auto stored = std::make_unique_for_overwrite<std::uint16_t[]>(pixels * layout.channels);
  read_pixels(file, OIIO::TypeDesc::UINT16, stored.get());
  image.encoding = ColourImage::Encoding::kLinearHalf;
  image.bytes.resize(pixels * 8);
  const HalfTable& colour = half_from_16bit(!declares_linear(file.spec));
  const HalfTable& linear = half_from_16bit(false);
  const std::uint16_t* in = stored.get();
  for (std::size_t i = 0; i < pixels; ++i, in += layout.channels) {
    const std::uint16_t alpha = layout.alpha < 0 ? 65535 : in[layout.alpha];
    std::uint16_t pixel[4];
    for (int c = 0; c < 3; ++c) {
      const std::uint16_t value = in[layout.colours == 3 ? c : 0];
      pixel[c] = colour[layout.premultiplied ? unpremultiplied(value, alpha, 65535) : value];
    }
    pixel[3] = linear[alpha];
    std::memcpy(image.bytes.data() + i * 8, pixel, 8);
  }
  return image;
}

ColourImage decode_float(OpenImage& file, ColourImage image) {
  const Layout layout = file.layout;
  const std::size_t pixels = file.pixels();
  const auto stored = std::make_unique_for_overwrite<float[]>(pixels * layout.channels);
  read_pixels(file, OIIO::TypeDesc::FLOAT, stored.get());
  image.encoding = ColourImage::Encoding::kLinearHalf;
  image.bytes.resize(pixels * 8);
  const float* in = stored.get();
  for (std::size_t i = 0; i < pixels; ++i, in += layout.channels) {
    const float alpha =
        layout.alpha < 0 ? 1.0f : std::clamp(finite_or_zero(in[layout.alpha]), 0.0f, 1.0f);
    const float divisor = layout.premultiplied && alpha > 0 ? alpha : 1.0f;
    std::uint16_t pixel[4];
    for (int c = 0; c < 3; ++c) {
      const float value = finite_or_zero(in[layout.colours == 3 ? c : 0]) / divisor;
      pixel[c] = half_bits(std::clamp(value, -kHalfMax, kHalfMax));
    }
    pixel[3] = half_bits(alpha);
    std::memcpy(image.bytes.data() + i * 8, pixel, 8);
  }
  return image;
}

/// The layout's channels at 8 bits, quantised from whatever the file stores.
std::unique_ptr<std::uint8_t[]> read_quantised(OpenImage& file) {
  const std::size_t count = file.pixels() * file.layout.channels;
  auto values = std::make_unique_for_overwrite<std::uint8_t[]>(count);
  if (file.spec.format == OIIO::TypeDesc::UINT8) {
    read_pixels(file, OIIO::TypeDesc::UINT8, values.get());
    return values;
  }
  const auto stored = std::make_unique_for_overwrite<float[]>(count);
  read_pixels(file, OIIO::TypeDesc::FLOAT, stored.get());
  std::transform(stored.get(), stored.get() + count, values.get(), [](float v) {
    return std::uint8_t(std::lround(255.0f * std::clamp(finite_or_zero(v), 0.0f, 1.0f)));
  });
  return values;
}

/// Values 0 and 1 of 8 bits are labels: no mask is at most 1/255 anywhere.
FileMask take_labels(const OpenImage& file, FileMask mask) {
  const auto highest = std::max_element(mask.coverage.begin(), mask.coverage.end());
  mask.from_ones = file.spec.format == OIIO::TypeDesc::UINT8 && *highest == 1;
  if (mask.from_ones)
    for (std::uint8_t& value : mask.coverage) value = std::uint8_t(255 * value);
  return mask;
}

}  // namespace

ImageSize read_image_size(const fs::path& path) {
  const OpenImage file = open_image(path);
  const int orientation = file.spec.get_int_attribute("Orientation", 1);
  return {file.spec.width, file.spec.height,
          orientation >= 1 && orientation <= 8 ? orientation : 1};
}

double pixels_of_largest(std::span<const fs::path> images) {
  double most = 0;
  for (const fs::path& image : images) try {
      const ImageSize size = read_image_size(image);
      most = std::max(most, double(size.width) * size.height);
    } catch (const Error&) {
    }
  return most;
}

ColourImage read_image(const fs::path& path) {
  OpenImage file = open_whole_image(path);
  ColourImage image;
  image.width = file.spec.width;
  image.height = file.spec.height;
  image.has_alpha = file.layout.alpha >= 0;
  try {
    switch (file.spec.format.basetype) {
      case OIIO::TypeDesc::UINT8:
        return decode_8bit(file, std::move(image));
      case OIIO::TypeDesc::UINT16:
        return decode_16bit(file, std::move(image));
      case OIIO::TypeDesc::HALF:
      case OIIO::TypeDesc::FLOAT:
      case OIIO::TypeDesc::DOUBLE:
        return decode_float(file, std::move(image));
      default:
        break;
    }
  } catch (const std::bad_alloc&) {
    out_of_memory(file);
  }
  unsupported(file);
}

FileMask read_mask(const fs::path& path) {
  OpenImage file = open_whole_image(path);
  const Layout layout = file.layout;
  const std::size_t pixels = file.pixels();
  FileMask mask({file.spec.width, file.spec.height, {}});
  try {
    const auto values = read_quantised(file);
    mask.coverage.resize(pixels);
    if (layout.alpha >= 0) {
      const std::uint8_t* in = values.get() + layout.alpha;
      for (std::size_t i = 0; i < pixels; ++i) mask.coverage[i] = in[i * layout.channels];
      const auto [low, high] = std::minmax_element(mask.coverage.begin(), mask.coverage.end());
      if (*low != *high) return take_labels(file, std::move(mask));
    }
    const std::uint8_t* in = values.get();
    for (std::size_t i = 0; i < pixels; ++i, in += layout.channels)
      mask.coverage[i] = layout.colours == 3 ? luminance(in[0], in[1], in[2]) : in[0];
    return take_labels(file, std::move(mask));
  } catch (const std::bad_alloc&) {
    out_of_memory(file);
  }
}

std::vector<std::uint8_t> encode_png(int width, int height, int channels,
                                     std::span<const std::uint8_t> bytes) {
  PHOTOHULL_CHECK(width > 0 && height > 0 && channels >= 1 && channels <= 4);
  PHOTOHULL_CHECK_OP(bytes.size(), ==, std::size_t(width) * height * channels);
  keep_to_one_thread();
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  if (channels == 2) spec.channelnames = {"Y", "A"};
  spec.alpha_channel = channels % 2 == 0 ? channels - 1 : -1;
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("png:compressionLevel", 3);  // a third of the default's time, hardly larger
  const auto output = OIIO::ImageOutput::create("png");
  if (!output) throw Error("PNG files cannot be written: OpenImageIO lacks its PNG plug-in");
  output->threads(1);
  std::vector<unsigned char> compressed;
  OIIO::Filesystem::IOVecOutput memory(compressed);
  if (!output->set_ioproxy(&memory) || !output->open("memory.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, bytes.data()) || !output->close())
    throw Error(concat("an image cannot be compressed (", one_line(output->geterror()), ")"));
  return compressed;
}

void write_png(AtomicFile& file, int width, int height, int channels,
               std::span<const std::uint8_t> bytes) {
  // Compressed in memory: OpenImageIO may take a full disk for a success.
  const std::vector<std::uint8_t> compressed = encode_png(width, height, channels, bytes);
  file.write(compressed.data(), compressed.size());
}

void write_png(AtomicFile& file, const RgbImage& picture) {
  write_png(file, picture.width, picture.height, 3, picture.rgb);
}

void write_png(const fs::path& path, int width, int height, int channels,
               std::span<const std::uint8_t> bytes) {
  AtomicFile file(path);
  write_png(file, width, height, channels, bytes);
  file.commit();
}

}  // namespace photohull::io
