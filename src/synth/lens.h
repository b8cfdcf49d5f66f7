// Lens distortion, both ways. [Brown71].
#pragma once

#include <optional>

#include "core/camera.h"

namespace photohull::synth {

/// A camera with its lens. Pixels follow core/camera.h.
struct LensCamera {
  Camera camera;
  Distortion distortion;  ///< none, or Brown with k1 k2 p1 p2

  /// Pixel of a world point, distortion included; nothing behind the camera.
  std::optional<glm::dvec2> project(const glm::dvec3& world) const;
  /// Position (x, y) on the plane z = 1 of the ideal camera that a pixel position shows; nothing
  /// where the lens folds over, so that no or several points would appear there.
  std::optional<glm::dvec2> undistorted(const glm::dvec2& pixel) const;
};

}  // namespace photohull::synth
