#include "io/row_writer.h"

#include <OpenImageIO/half.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace photohull::io {
namespace {

constexpr int kCurve = 65535;

/// 8-bit sRGB of linear light; so fine that rounding differs from the exact by 0.06 levels at most.
const std::vector<std::uint8_t>& srgb_curve() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> t(kCurve + 1);
    for (int i = 0; i <= kCurve; ++i)
      t[std::size_t(i)] = std::uint8_t(std::lround(255 * srgb_from_linear(double(i) / kCurve)));
    return t;
  }();
  return table;
}

}  // namespace

RowWriter::RowWriter(ColourImage& image) : image_(image) {
  image.bytes.resize(std::size_t(image.width) * std::size_t(image.height) *
                     image.bytes_per_pixel());
}

void RowWriter::operator()(const float* row) {
  const std::vector<std::uint8_t>& curve = srgb_curve();
  for (int x = 0; x < image_.width; ++x, row += 4)
    if (image_.encoding == ColourImage::Encoding::kSrgb8) {
      for (int c = 0; c < 3; ++c)
        image_.bytes[at_++] =
            curve[std::size_t(std::clamp(row[c], 0.0f, 1.0f) * float(kCurve) + 0.5f)];
      image_.bytes[at_++] = std::uint8_t(255 * std::clamp(row[3], 0.0f, 1.0f) + 0.5f);
    } else {
      for (int c = 0; c < 4; ++c, at_ += 2) {
        const std::uint16_t bits = half(row[c]).bits();
        std::memcpy(&image_.bytes[at_], &bits, 2);
      }
    }
}

}  // namespace photohull::io
