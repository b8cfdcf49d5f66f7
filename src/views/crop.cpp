#include "views/crop.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace photohull {
namespace {

/// A rectangle of pixels.
struct Frame {
  glm::ivec2 low{0}, size{0};
};

/// Copies a rectangle of row-major pixels to the front of the same memory and shrinks it.
/// A pixel takes so many of the values.
template <typename T>
void crop_rows(std::vector<T>& values, std::size_t each, int width, const Frame& frame) {
  const auto& [low, size] = frame;
  for (int y = 0; y < size.y; ++y)
    std::memmove(&values[std::size_t(y) * size.x * each],
                 &values[(std::size_t(y + low.y) * width + low.x) * each],
                 size.x * each * sizeof(T));
  values.resize(std::size_t(size.x) * size.y * each);
  values.shrink_to_fit();
}

void crop_mask(int width, const Frame& frame, Mask& mask) {
  if (mask.empty()) return;
  crop_rows(mask.coverage, 1, width, frame);
  mask.width = frame.size.x;
  mask.height = frame.size.y;
}

void crop_silhouette(int width, const Frame& frame, ViewSilhouette& silhouette) {
  crop_mask(width, frame, silhouette.widened);
  SilhouetteDistance& distance = silhouette.distance;
  if (!distance.pixels.empty()) {
    crop_rows(distance.pixels, 1, width, frame);
    distance.width = frame.size.x;
    distance.height = frame.size.y;
  }
  for (LinePoint& point : silhouette.lines) {
    point.x -= float(frame.low.x);
    point.y -= float(frame.low.y);
  }
  std::erase_if(silhouette.lines, [&](const LinePoint& p) {
    return p.x < 0 || p.y < 0 || p.x > float(frame.size.x - 1) || p.y > float(frame.size.y - 1);
  });
}

/// What crop_to_box keeps of a camera's image.
Frame kept_frame(const Box& box, int margin, const Camera& camera, int multiple) {
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
  const glm::ivec2 from(glm::clamp(glm::floor(least) - double(margin), glm::dvec2(0), last));
  const glm::ivec2 low = multiple * (from / multiple);
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

void crop_to_box(const Box& box, int margin, PreparedView& view, int multiple) {
  Intrinsics& k = view.camera.intrinsics;
  const Frame frame = kept_frame(box, margin, view.camera, multiple);
  if (frame.size.x == k.width && frame.size.y == k.height) return;
  crop_rows(view.image.bytes, std::size_t(view.image.bytes_per_pixel()), k.width, frame);
  view.image.width = frame.size.x;
  view.image.height = frame.size.y;
  crop_mask(k.width, frame, view.mask);
  crop_silhouette(k.width, frame, view.silhouette);
  cut(frame, k);
}

Intrinsics cropped_intrinsics(const Box& box, int margin, const Camera& camera, int multiple) {
  Intrinsics k = camera.intrinsics;
  cut(kept_frame(box, margin, camera, multiple), k);
  return k;
}

}  // namespace photohull
