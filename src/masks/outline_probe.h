// How far from a view's outline points in space lie: asked for millions of points, so that it
// is short and inline.
#pragma once

#include <algorithm>

#include "core/camera.h"
#include "core/silhouette.h"

namespace photohull {

/// Where a point appears in a view.
struct Appearance {
  double x = 0, y = 0;  ///< pixels, on the image
  double depth = 0;     ///< in the unit of the point
};

/// A camera and the distance to its outline, which must outlive it.
class OutlineProbe {
 public:
  /// `projection`: to homogeneous pixels; the third coordinate is the depth. `distance`: nullptr
  /// where nothing is known.
  OutlineProbe(const glm::dmat4x3& projection, int width, int height,
               const SilhouetteDistance* distance)
      : projection_(projection), distance_(distance), right_(width - 0.5), bottom_(height - 0.5) {}
  OutlineProbe(const Camera& camera, const SilhouetteDistance* distance)
      : OutlineProbe(camera.projection(), camera.intrinsics.width, camera.intrinsics.height,
                     distance) {}

  /// Is anything known? Without, only whether it sees a point may be asked.
  bool has_outline() const { return distance_ != nullptr; }

  /// False where the point is behind the view, or off its image.
  bool sees(const glm::dvec3& point, Appearance& out) const {
    const glm::dmat4x3& m = projection_;
    out.depth = m[0].z * point.x + m[1].z * point.y + m[2].z * point.z + m[3].z;
    if (!(out.depth > 0)) return false;
    const double inverse = 1 / out.depth;
    out.x = inverse * (m[0].x * point.x + m[1].x * point.y + m[2].x * point.z + m[3].x);
    out.y = inverse * (m[0].y * point.x + m[1].y * point.y + m[2].y * point.z + m[3].y);
    return out.x >= -0.5 && out.y >= -0.5 && out.x <= right_ && out.y <= bottom_;
  }

  /// Signed pixels from the outline, bilinear.
  double distance(const Appearance& at) const {
    const int width = distance_->width, height = distance_->height;
    const int left = int(at.x + 1) - 1, top = int(at.y + 1) - 1;  // floor, from -1 on
    const double u = at.x - left, v = at.y - top;
    const int x0 = std::max(left, 0), x1 = std::min(left + 1, width - 1);
    const float* above = row(std::max(top, 0));
    const float* below = row(std::min(top + 1, height - 1));
    return (1 - v) * ((1 - u) * double(above[x0]) + u * double(above[x1])) +
           v * ((1 - u) * double(below[x0]) + u * double(below[x1]));
  }

  /// The same of the nearest pixel.
  double nearest_distance(const Appearance& at) const {
    return double(distance_->pixels[nearest_pixel(at)]);
  }

  /// Index of the nearest pixel.
  std::size_t nearest_pixel(const Appearance& at) const {
    const int x = std::min(int(at.x + 0.5), distance_->width - 1);
    const int y = std::min(int(at.y + 0.5), distance_->height - 1);
    return std::size_t(y) * std::size_t(distance_->width) + std::size_t(x);
  }

 private:
  const float* row(int y) const {
    return &distance_->pixels[std::size_t(y) * std::size_t(distance_->width)];
  }

  glm::dmat4x3 projection_;
  const SilhouetteDistance* distance_;
  double right_, bottom_;  ///< pixels, edges of the image
};

}  // namespace photohull
