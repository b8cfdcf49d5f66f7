// Image files decoded to fewer pixels, without ever holding all of the file's.
#include <OpenImageIO/half.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <vector>

#include "core/error.h"
#include "core/image_scale.h"
#include "io/area_average.h"
#include "io/image_file.h"
#include "io/jpeg_rows.h"
#include "io/open_image.h"
#include "io/row_writer.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr int kStrip = 64;  // rows read at once: a multiple of most files' compressed blocks
constexpr float kHalfMax = 65504.0f;

/// Linear light of every 8-bit and 16-bit value.
template <int count>
const std::vector<float>& linear_light() {
  static const std::vector<float> table = [] {
    std::vector<float> t(count);
    for (int i = 0; i < count; ++i) t[std::size_t(i)] = float(linear_from_srgb(i / (count - 1.0)));
    return t;
  }();
  return table;
}

/// Calls use(row, values) for every row of the file, its layout's channels as `T`.
template <typename T, typename Use>
void for_each_row(OpenImage& file, OIIO::TypeDesc type, Use&& use) {
  const OIIO::ImageSpec& s = file.spec;
  const bool tiled = s.tile_width > 0;
  const int strip = tiled ? s.tile_height : kStrip;
  const std::size_t row = std::size_t(s.width) * std::size_t(file.layout.channels);
  std::vector<T> values(row * std::size_t(strip));
  for (int y = 0; y < s.height; y += strip) {
    const int count = std::min(strip, s.height - y);
    const int from = s.y + y, to = from + count, channels = file.layout.channels;
    const bool read =
        tiled ? file.input->read_tiles(0, 0, s.x, s.x + s.width, from, to, s.z, s.z + 1, 0,
                                       channels, type, values.data())
              : file.input->read_scanlines(0, 0, from, to, s.z, 0, channels, type, values.data());
    if (!read || file.input->has_error()) damaged(file, file.input->geterror());
    for (int i = 0; i < count; ++i) use(y + i, values.data() + row * std::size_t(i));
  }
}

/// A stored pixel's channels of the layout as straight RGBA in linear light.
struct FromInteger {
  const Layout& layout;
  const std::vector<float>* curve;  ///< null: stored values are linear
  std::uint32_t maximum;

  template <typename T>
  void operator()(const T* in, float* out) const {
    const std::uint32_t alpha = layout.alpha < 0 ? maximum : in[layout.alpha];
    for (int c = 0; c < 3; ++c) {
      std::uint32_t value = in[layout.colours == 3 ? c : 0];
      if (layout.premultiplied) value = unpremultiplied(value, alpha, maximum);
      out[c] = curve ? (*curve)[value] : float(value) / float(maximum);
    }
    out[3] = float(alpha) / float(maximum);
  }
};

struct FromFloat {
  const Layout& layout;

  void operator()(const float* in, float* out) const {
    const float alpha =
        layout.alpha < 0 ? 1.0f : std::clamp(finite_or_zero(in[layout.alpha]), 0.0f, 1.0f);
    const float divisor = layout.premultiplied && alpha > 0 ? alpha : 1.0f;
    for (int c = 0; c < 3; ++c)
      out[c] = std::clamp(finite_or_zero(in[layout.colours == 3 ? c : 0]) / divisor, -kHalfMax,
                          kHalfMax);
    out[3] = alpha;
  }
};

template <typename T, typename ToLinear>
void average_rows(OpenImage& file, OIIO::TypeDesc type, const ToLinear& to_linear, double scale,
                  ColourImage& image) {
  const int width = file.spec.width, channels = file.layout.channels;
  AreaAverage average(width, file.spec.height, glm::dvec2(1 / scale), 4, RowWriter(image));
  std::vector<float> linear(4 * std::size_t(width));
  for_each_row<T>(file, type, [&](int, const T* in) {
    for (int x = 0; x < width; ++x, in += channels) to_linear(in, &linear[4 * std::size_t(x)]);
    average.add(linear.data());
  });
}

/// The largest power of two, 8 at most, whose reduced picture is no smaller than `scale` asks for.
int jpeg_reduction(double scale) {
  int reduction = 1;
  while (reduction < 8 && 2 * reduction * scale <= 1) reduction *= 2;
  return reduction;
}

[[noreturn]] void refuse(const OpenImage& file, const JpegRows& rows) {
  if (rows.out_of_memory()) out_of_memory(file);
  damaged(file, rows.error());
}

void decode_jpeg(const OpenImage& file, double scale, ColourImage& image) {
  const int reduction = jpeg_reduction(scale);
  JpegRows rows(file.path, reduction);
  if (!rows.width()) refuse(file, rows);
  PHOTOHULL_CHECK_OP(rows.width(), ==, scaled_length(file.spec.width, 1.0 / reduction));
  std::vector<std::uint8_t> row(4 * std::size_t(rows.width()));
  if (reduction * scale == 1) {  // as libjpeg has them, without a detour through linear light
    image.bytes.resize(row.size() * std::size_t(image.height));
    for (int y = 0; y < image.height; ++y)
      if (!rows.read_row(&image.bytes[row.size() * std::size_t(y)])) refuse(file, rows);
  } else {
    const std::vector<float>& curve = linear_light<256>();
    std::vector<float> linear(row.size(), 1.0f);
    AreaAverage average(double(file.spec.width) / reduction, double(file.spec.height) / reduction,
                        glm::dvec2(1 / (scale * reduction)), 4, RowWriter(image));
    for (int y = 0; y < rows.height(); ++y) {
      if (!rows.read_row(row.data())) refuse(file, rows);
      for (std::size_t i = 0; i < row.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c) linear[i + c] = curve[row[i + c]];
      average.add(linear.data());
    }
  }
  if (!rows.finish()) refuse(file, rows);
}

bool is_plain_jpeg(const OpenImage& file) {
  return std::strcmp(file.input->format_name(), "jpeg") == 0 &&
         (file.spec.nchannels == 1 || file.spec.nchannels == 3) &&
         file.spec.get_string_attribute("jpeg:ColorSpace") != "CMYK" &&
         file.spec.get_string_attribute("jpeg:ColorSpace") != "YCbCrK";
}

void decode(OpenImage& file, double scale, ColourImage& image) {
  const Layout& layout = file.layout;
  image.encoding = file.spec.format == OIIO::TypeDesc::UINT8 ? ColourImage::Encoding::kSrgb8
                                                             : ColourImage::Encoding::kLinearHalf;
  switch (file.spec.format.basetype) {
    case OIIO::TypeDesc::UINT8:
      if (is_plain_jpeg(file)) return decode_jpeg(file, scale, image);
      return average_rows<std::uint8_t>(file, OIIO::TypeDesc::UINT8,
                                        FromInteger{layout, &linear_light<256>(), 255}, scale,
                                        image);
    case OIIO::TypeDesc::UINT16: {
      const auto* curve = declares_linear(file.spec) ? nullptr : &linear_light<65536>();
      return average_rows<std::uint16_t>(file, OIIO::TypeDesc::UINT16,
                                         FromInteger{layout, curve, 65535}, scale, image);
    }
    case OIIO::TypeDesc::HALF:
    case OIIO::TypeDesc::FLOAT:
    case OIIO::TypeDesc::DOUBLE:
      return average_rows<float>(file, OIIO::TypeDesc::FLOAT, FromFloat{layout}, scale, image);
    default:
      unsupported(file);
  }
}

float quantised(std::uint8_t value) { return value; }
float quantised(float value) {
  return std::round(255.0f * std::clamp(finite_or_zero(value), 0.0f, 1.0f));
}

/// One of a mask's channels at the new size, as coverage and as if it were of labels, 0 and 1:
/// which it is is known at the end.
struct MaskChannel {
  std::vector<std::uint8_t> coverage, labels;
  float low = 255, high = 0;  ///< of the file's values

  void see(float value) { low = std::min(low, value), high = std::max(high, value); }
  void add(float mean) {
    coverage.push_back(std::uint8_t(mean + 0.5f));
    if (high <= 1)
      labels.push_back(std::uint8_t(255 * std::min(mean, 1.0f) + 0.5f));
    else if (!labels.empty())
      labels = {};
  }
  FileMask take(int width, int height, bool may_be_labels) {
    const bool ones = may_be_labels && high == 1;
    return {Mask{width, height, std::move(ones ? labels : coverage)}, ones};
  }
};

/// Alpha and luminance side by side: which of them is the mask is known at the end.
template <typename T>
FileMask average_mask(OpenImage& file, OIIO::TypeDesc type, const glm::dvec2& scale) {
  const Layout& layout = file.layout;
  const int width = file.spec.width;
  MaskChannel alpha, colour;
  AreaAverage average(width, file.spec.height, 1.0 / scale, 2, [&](const float* row) {
    for (int x = 0; x < average.width(); ++x) {
      alpha.add(row[2 * x]);
      colour.add(row[2 * x + 1]);
    }
  });
  std::vector<float> pairs(2 * std::size_t(width), 255.0f);
  for_each_row<T>(file, type, [&](int, const T* in) {
    for (std::size_t x = 0; x < std::size_t(width); ++x, in += layout.channels) {
      const auto at = [&](int c) { return std::uint8_t(quantised(in[c])); };
      if (layout.alpha >= 0) alpha.see(pairs[2 * x] = quantised(in[layout.alpha]));
      colour.see(pairs[2 * x + 1] = layout.colours == 3 ? luminance(at(0), at(1), at(2)) : at(0));
    }
    average.add(pairs.data());
  });
  MaskChannel& mask = alpha.low < alpha.high ? alpha : colour;
  return mask.take(average.width(), average.height(), sizeof(T) == 1);
}

}  // namespace

ColourImage read_image(const fs::path& path, double scale) {
  if (scale == 1) return read_image(path);
  OpenImage file = open_whole_image(path);
  ColourImage image;
  image.width = scaled_length(file.spec.width, scale);
  image.height = scaled_length(file.spec.height, scale);
  image.has_alpha = file.layout.alpha >= 0;
  try {
    decode(file, scale, image);
  } catch (const std::bad_alloc&) {
    out_of_memory(file);
  }
  return image;
}

FileMask read_mask(const fs::path& path, double scale) {
  return read_mask(path, glm::dvec2(scale));
}

FileMask read_mask(const fs::path& path, const glm::dvec2& scale) {
  if (scale == glm::dvec2(1)) return read_mask(path);
  OpenImage file = open_whole_image(path);
  try {
    return file.spec.format == OIIO::TypeDesc::UINT8
               ? average_mask<std::uint8_t>(file, OIIO::TypeDesc::UINT8, scale)
               : average_mask<float>(file, OIIO::TypeDesc::FLOAT, scale);
  } catch (const std::bad_alloc&) {
    out_of_memory(file);
  }
}

}  // namespace photohull::io
