#include "io/reduce_image.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image_scale.h"
#include "io/area_average.h"
#include "io/row_writer.h"

namespace photohull::io {

ColourImage reduced(const ColourImage& image, double scale) {
  if (scale == 1) return image;
  ColourImage out;
  out.width = scaled_length(image.width, scale);
  out.height = scaled_length(image.height, scale);
  out.encoding = image.encoding;
  out.has_alpha = image.has_alpha;
  AreaAverage average(image.width, image.height, glm::dvec2(1 / scale), 4, RowWriter(out));
  std::vector<glm::vec4> row(std::size_t(image.width));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) row[std::size_t(x)] = image.linear(x, y);
    average.add(&row[0].x);
  }
  return out;
}

Mask reduced(const Mask& mask, const glm::dvec2& scale) {
  if (mask.empty() || scale == glm::dvec2(1)) return mask;
  Mask out;
  AreaAverage average(mask.width, mask.height, 1.0 / scale, 1, [&](const float* row) {
    for (int x = 0; x < average.width(); ++x) out.coverage.push_back(std::uint8_t(row[x] + 0.5f));
  });
  out.width = average.width(), out.height = average.height();
  std::vector<float> row(std::size_t(mask.width));
  for (int y = 0; y < mask.height; ++y) {
    for (std::size_t x = 0; x < row.size(); ++x)
      row[x] = mask.coverage[std::size_t(y) * row.size() + x];
    average.add(row.data());
  }
  return out;
}

}  // namespace photohull::io
