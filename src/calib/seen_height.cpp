#include "calib/seen_height.h"

#include <algorithm>

namespace photohull {
namespace {

constexpr int kSteps = 256;         // along the box's height
constexpr std::size_t kEnough = 3;  // cameras

}  // namespace

Box lowered_to_seen(const Box& box, std::span<const Camera> cameras) {
  const std::size_t enough = std::min(kEnough, cameras.size());
  glm::dvec3 place = box.center();
  for (int step = kSteps; step > 0; --step) {
    place.z = box.min.z + box.size().z * step / kSteps;
    const auto seeing = std::ranges::count_if(cameras, [&](const Camera& camera) {
      const auto pixel = camera.project(place);
      return pixel && camera.on_image(*pixel);
    });
    if (std::size_t(seeing) >= enough) return {box.min, {box.max.x, box.max.y, place.z}};
  }
  return box;
}

}  // namespace photohull
