// Axis-aligned boxes in world coordinates.
#pragma once

#include <glm/glm.hpp>

namespace photohull {

struct Box {
  glm::dvec3 min{0.0};
  glm::dvec3 max{0.0};

  glm::dvec3 size() const { return max - min; }
  glm::dvec3 center() const { return 0.5 * (min + max); }
  double diagonal() const { return glm::length(size()); }
  bool contains(const glm::dvec3& p) const {
    return glm::all(glm::greaterThanEqual(p, min)) && glm::all(glm::lessThanEqual(p, max));
  }
};

}  // namespace photohull
