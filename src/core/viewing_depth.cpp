#include "core/viewing_depth.h"

#include <algorithm>
#include <vector>

#include "core/clip_ray.h"
#include "core/median.h"

namespace photohull {
namespace {

constexpr int kRays = 8;  // along each side of the image

}  // namespace

double viewing_depth(const glm::dmat4x3& projection, const glm::dvec3& centre, int width,
                     int height, const Box& box) {
  const glm::dvec3 at = projection * glm::dvec4(box.center(), 1);
  const double middle = at.z;
  const glm::dvec2 pixel = glm::dvec2(at) / middle;
  const bool on_image = middle > 0 && pixel.x >= -0.5 && pixel.y >= -0.5 &&
                        pixel.x <= width - 0.5 && pixel.y <= height - 0.5;
  if (on_image && !box.contains(centre)) return middle;
  const glm::dmat3 ray_of = glm::inverse(glm::dmat3(projection[0], projection[1], projection[2]));
  std::vector<double> leaving;
  for (int y = 0; y < kRays; ++y)
    for (int x = 0; x < kRays; ++x) {
      const glm::dvec2 place(width * (x + 0.5) / kRays - 0.5, height * (y + 0.5) / kRays - 0.5);
      // A step along this direction is one of depth.
      if (const auto part = clip_ray(box, centre, ray_of * glm::dvec3(place, 1)))
        leaving.push_back(part->second);
    }
  return leaving.empty() ? middle : std::max(middle, median(leaving));
}

}  // namespace photohull
