// Private to module texture: where the mesh's points lie in photographs, and which pixels a
// triangle covers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "core/camera.h"
#include "core/mesh.h"

namespace photohull::texture {

/// A point in an image: pixel position, and one over its depth (one where all depths count alike).
using Projected = glm::dvec3;

/// A triangle in an image.
struct FaceInImage {
  std::array<Projected, 3> corners;

  glm::dvec2 at(int i) const { return glm::dvec2(corners[std::size_t(i)]); }
  /// Twice the area in pixels; positive where the triangle's front is seen, for pixels' y points
  /// down.
  double double_area() const {
    const glm::dvec2 u = at(1) - at(0), v = at(2) - at(0);
    return u.y * v.x - u.x * v.y;
  }
};

/// The pixel centres that a triangle covers, and how deep the triangle lies there.
class FacePixels {
 public:
  /// `margin`: pixels by which the triangle is grown; negative: shrunk.
  FacePixels(const FaceInImage& face, int width, int height, double margin = 0) : face_(face) {
    const double area = face.double_area();
    turn_ = area > 0 ? 1 : -1;
    covers_ = std::abs(area) > 1e-12;
    glm::dvec2 low(face.at(0)), high = low;
    for (int i = 0; i < 3; ++i) {
      low = glm::min(low, face.at(i));
      high = glm::max(high, face.at(i));
      const glm::dvec2 side = face.at((i + 1) % 3) - face.at(i);
      const double length = glm::length(side);
      across_[i] = length > 0 ? glm::dvec2(side.y, -side.x) / length : glm::dvec2(0);
    }
    margin_ = margin + 1e-9;
    const double grown = std::max(margin_, 0.0);
    first_ = {bounded(std::ceil(low.x - grown), width), bounded(std::ceil(low.y - grown), height)};
    end_ = {bounded(std::floor(high.x + grown) + 1, width),
            bounded(std::floor(high.y + grown) + 1, height)};
  }

  /// Calls `f(x, y)` row by row.
  template <typename F>
  void each(const F& f) const {
    if (!covers_) return;
    for (int y = first_.y; y < end_.y; ++y)
      for (int x = first_.x; x < end_.x; ++x)
        if (holds({double(x), double(y)})) f(x, y);
  }

  bool holds(const glm::dvec2& pixel) const { return inset(pixel) >= -margin_; }
  /// Distance to the nearest of the lines along its sides, pixels; negative outside.
  double inset(const glm::dvec2& pixel) const {
    double least = 1e300;
    for (int i = 0; i < 3; ++i)
      least = std::min(least, turn_ * glm::dot(across_[i], pixel - face_.at(i)));
    return least;
  }

 private:
  static int bounded(double value, int size) { return int(std::clamp(value, 0.0, double(size))); }

  const FaceInImage& face_;
  std::array<glm::dvec2, 3> across_;
  double turn_ = 1, margin_ = 0;
  bool covers_ = false;
  glm::ivec2 first_{0}, end_{0};
};

/// Weights of the corners at a pixel, in the image; extrapolated outside.
inline glm::dvec3 image_weights(const FaceInImage& face, const glm::dvec2& pixel) {
  const glm::dvec2 u = face.at(1) - face.at(0), v = face.at(2) - face.at(0), p = pixel - face.at(0);
  const double area = u.x * v.y - u.y * v.x;
  if (area == 0) return {1, 0, 0};
  const double b = (p.x * v.y - p.y * v.x) / area, c = (u.x * p.y - u.y * p.x) / area;
  return {1 - b - c, b, c};
}

/// One over the depth of the triangle's plane at a pixel.
inline double inverse_depth(const FaceInImage& face, const glm::dvec3& weights) {
  return weights.x * face.corners[0].z + weights.y * face.corners[1].z +
         weights.z * face.corners[2].z;
}

/// Weights of the corners on the triangle itself, of weights in the image.
inline glm::dvec3 surface_weights(const FaceInImage& face, const glm::dvec3& weights) {
  const double whole = inverse_depth(face, weights);
  if (!(whole > 0)) return weights;
  return weights * glm::dvec3(face.corners[0].z, face.corners[1].z, face.corners[2].z) / whole;
}

/// The mesh's points on a plane: an image, or an orthographic projection along a world axis.
class Projector {
 public:
  /// Sign and axis of the direction that looks at the viewer: +x, -x, +y, -y, +z, -z.
  static constexpr int kAxes = 6;

  explicit Projector(const Camera& camera, const glm::dvec3& origin)
      : camera_(camera), origin_(origin) {}
  /// `texel`: world units.
  Projector(int axis, double texel) : axis_(axis), texel_(texel) {}

  /// Is the mesh's point, relative to its origin, in front? `out` is set if so.
  bool project(const glm::vec3& point, Projected& out) const {
    if (axis_ >= 0) {
      const int k = axis_ / 2;
      const double sign = axis_ % 2 == 0 ? 1 : -1;
      out = {sign * double(point[(k + 1) % 3]) / texel_, -double(point[(k + 2) % 3]) / texel_, 1};
      return true;
    }
    const glm::dvec3 p = camera_.to_camera(origin_ + glm::dvec3(point));
    if (!(p.z > 0)) return false;
    const Intrinsics& k = camera_.intrinsics;
    out = {(k.fx * p.x + k.skew * p.y) / p.z + k.cx, k.fy * p.y / p.z + k.cy, 1 / p.z};
    return true;
  }

  bool project(const TriMesh& mesh, std::size_t face, FaceInImage& out) const {
    for (int i = 0; i < 3; ++i)
      if (!project(mesh.positions[mesh.triangles[face][i]], out.corners[std::size_t(i)]))
        return false;
    return true;
  }

 private:
  Camera camera_;
  glm::dvec3 origin_{0};
  int axis_ = -1;
  double texel_ = 1;
};

}  // namespace photohull::texture
