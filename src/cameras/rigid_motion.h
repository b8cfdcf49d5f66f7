// Rigid motions that take points to points.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"

namespace photohull {

struct RigidMotion {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};

  glm::dvec3 operator()(const glm::dvec3& x) const { return rotation * x + translation; }
  RigidMotion inverse() const;
  /// The camera in the world that the motion leads to.
  Camera moved(Camera camera) const;
};

/// Two places that may show the same point of an object, in worlds that differ by a motion.
struct PointPair {
  glm::dvec3 from{0.0}, to{0.0};
  double tolerance = 0;  ///< world units: how far apart they may be after the right motion
};

/// The motion that brings `from` nearest to `to` [Umeyama91]: three pairs or more, not on a line.
RigidMotion fit_motion(std::span<const PointPair> pairs);

struct AgreedMotion {
  RigidMotion motion;
  std::vector<std::size_t> agreeing;  ///< indices of the pairs within their tolerances
};

/// The motion that most pairs agree on, by samples of three pairs [Fischler81], fitted to all that
/// agree. Nothing where fewer than `fewest` do, or where those lie on a line within their
/// tolerances. The same for the same pairs.
std::optional<AgreedMotion> find_motion(std::span<const PointPair> pairs, std::size_t fewest);

}  // namespace photohull
