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

/// A rectangle of pixels.
struct Frame {
  glm::ivec2 low{0}, size{0};
};

/// What crop_to_box keeps of a camera's image.
Frame kept_frame(const Box& box, int margin, const Camera& camera) {
  const Intrinsics& k = camera.intrinsics;
  const Frame all{glm::ivec2(0), {k.width, k.height}};
  glm::dvec2 least(1e300), greatest(-1e300);
  for (int corner = 0; corner < 8; ++corner) {
    const auto pixel =
        camera.project({(corner & 1 ? box.max : box.min).x, (corner & 2 ? box.max : box.min).y,
                        (corner & 4 ? box.max : box.min).z});
    if (!pixel) return all;
    least = glm::min(least, *pixel);
    greatest = glm::max(greatest, *pixel);
  }
  const glm::dvec2 last(all.size - 1);
  if (glm::any(glm::greaterThan(least, last)) || glm::any(glm::lessThan(greatest, glm::dvec2(0))))
    return all;
  const glm::ivec2 low(glm::clamp(glm::floor(least) - double(margin), glm::dvec2(0), last));
  const glm::ivec2 high(glm::clamp(glm::ceil(greatest) + double(margin), glm::dvec2(0), last));
  return {low, high - low + 1};
}

void cut(const Frame& frame, Intrinsics& k) {
  k.width = frame.size.x;
  k.height = frame.size.y;
  k.cx -= frame.low.x;
  k.cy -= frame.low.y;
}

}  // namespace

void crop_to_box(const Box& box, int margin, PreparedView& view) {
  Intrinsics& k = view.camera.intrinsics;
  const auto [low, size] = kept_frame(box, margin, view.camera);
  if (size.x == k.width && size.y == k.height) return;
  crop_rows(view.image.bytes, view.image.bytes_per_pixel(), k.width, low, size);
  if (!view.mask.empty()) crop_rows(view.mask.coverage, 1, k.width, low, size);
  view.image.width = view.mask.width = size.x;
  view.image.height = view.mask.height = size.y;
  cut({low, size}, k);
}

Intrinsics cropped_intrinsics(const Box& box, int margin, const Camera& camera) {
  Intrinsics k = camera.intrinsics;
  cut(kept_frame(box, margin, camera), k);
  return k;
}

}  // namespace photohull
