// Cameras. Frames, units and pixel conventions of the whole program are said here, once:
//
//   world    right-handed, in the scene's own unit; exported files keep it.
//   camera   x right, y down, z forward (OpenCV); x_cam = R x_world + t, "cam_from_world".
//   pixels   the centre of the top-left pixel is (0, 0); x right, y down. Importers convert.
//            Texture coordinates add 0.5 at the last moment.
//   depth    linear distance along the optical axis (camera z), in world units.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

namespace photohull {

/// Linear part of the projection: u = (fx x + skew y) / z + cx, v = fy y / z + cy, in pixels.
struct Intrinsics {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  double fx = 0, fy = 0, skew = 0, cx = 0, cy = 0;

  /// Rows of K; glm stores columns, so k()[column][row].
  glm::dmat3 k() const;
};

/// cam_from_world: x_cam = rotation * x_world + translation.
struct Pose {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};
};

/// Lens distortion as the source states it; removed by calib::prepare_views.
enum class DistortionModel {
  kNone,
  kBrown,       ///< OpenCV: k1 k2 p1 p2 k3 k4 k5 k6 (rational when k4..k6 are not zero)
  kFisheye,     ///< OpenCV fisheye (equidistant): k1 k2 k3 k4
  kPolynomial,  ///< Brown without denominator: k1 k2 p1 p2 k3 k4, with k4 of the eighth power
  kMeasured     ///< ideal = distorted (1 + k1 r^2 + k2 r^4), r of the distorted point
};

struct Distortion {
  DistortionModel model = DistortionModel::kNone;
  std::array<double, 8> coefficients{};
};

/// An ideal pinhole camera with a pose.
struct Camera {
  Intrinsics intrinsics;
  Pose cam_from_world;

  /// Optical centre in world coordinates.
  glm::dvec3 center() const;
  /// Optical axis (unit, world).
  glm::dvec3 forward() const;
  glm::dvec3 to_camera(const glm::dvec3& world) const;
  /// Pixel position of a world point; nothing when it is not in front of the camera.
  std::optional<glm::dvec2> project(const glm::dvec3& world) const;
  /// Unit direction in world coordinates of the ray through a pixel position.
  glm::dvec3 ray(const glm::dvec2& pixel) const;
  /// Is the pixel position on the image (its outermost pixel areas included)?
  bool on_image(const glm::dvec2& pixel) const;
  /// Homogeneous texture coordinates (s, t, q) = p * (x, 1): rows of K [R | t], as a 3x4 matrix
  /// (columns of glm's 4x3). Segal et al. 1992; q is the depth.
  glm::dmat4x3 projection() const;
};

}  // namespace photohull
