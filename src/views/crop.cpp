#include "views/crop.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace photohull {
namespace {

/// Copies a rectangle of row-major pixels to the front of the same memory and shrinks it.
void crop_rows(std::vector<std::uint8_t>& bytes, std::size_t pixel_bytes, int width,
               const glm::ivec2& low, const glm::ivec2& size) {
  for (int y = 0; y < size.y; ++y)
    std::memmove(&bytes[std::size_t(y) * size.x * pixel_bytes],
                 &bytes[(std::size_t(y + low.y) * width + low.x) * pixel_bytes],
                 size.x * pixel_bytes);
  bytes.resize(std::size_t(size.x) * size.y * pixel_bytes);
  bytes.shrink_to_fit();
}

}  // namespace

void crop_to_box(const Box& box, int margin, PreparedView& view) {
  glm::dvec2 least(1e300), greatest(-1e300);
  for (int corner = 0; corner < 8; ++corner) {
    const auto pixel =
        view.camera.project({(corner & 1 ? box.max : box.min).x, (corner & 2 ? box.max : box.min).y,
                             (corner & 4 ? box.max : box.min).z});
    if (!pixel) return;
    least = glm::min(least, *pixel);
    greatest = glm::max(greatest, *pixel);
  }
  Intrinsics& k = view.camera.intrinsics;
  const glm::dvec2 last(k.width - 1, k.height - 1);
  const glm::ivec2 low(glm::clamp(glm::floor(least) - double(margin), glm::dvec2(0), last));
  const glm::ivec2 high(glm::clamp(glm::ceil(greatest) + double(margin), glm::dvec2(0), last));
  const glm::ivec2 size = high - low + 1;
  const bool off_image =
      glm::any(glm::greaterThan(least, last)) || glm::any(glm::lessThan(greatest, glm::dvec2(0)));
  if (off_image || (size.x == k.width && size.y == k.height)) return;
  crop_rows(view.image.bytes, view.image.bytes_per_pixel(), k.width, low, size);
  if (!view.mask.empty()) crop_rows(view.mask.coverage, 1, k.width, low, size);
  view.image.width = view.mask.width = k.width = size.x;
  view.image.height = view.mask.height = k.height = size.y;
  k.cx -= low.x;
  k.cy -= low.y;
}

}  // namespace photohull
