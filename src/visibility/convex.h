// Convex solids cut by planes. Private to visibility.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/box.h"
#include "core/camera.h"

namespace photohull::visibility {

/// A convex solid by its faces' corners; empty where nothing is left.
class Convex {
 public:
  explicit Convex(const Box& box);
  /// Keeps the half-space normal . p >= offset.
  void cut(const glm::dvec3& normal, double offset);
  /// Keeps what the camera has before `near` and on its image.
  void cut(const Camera& camera, double near);
  std::vector<glm::dvec3> corners() const;  ///< repeated where faces meet

 private:
  std::vector<std::vector<glm::dvec3>> faces_;
};

}  // namespace photohull::visibility
