// A result moved, turned and scaled onto the truth.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "core/mesh.h"
#include "core/progress.h"
#include "eval/truth.h"

namespace photohull::eval {

/// x' = scale * rotation * x + translation, from the result's world to the truth's.
struct Alignment {
  double scale = 1;
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};
  double rms = 0;      ///< of the pairs that count, the truth's world units
  double degrees = 0;  ///< by which the rotation turns

  glm::dvec3 operator()(const glm::dvec3& p) const { return scale * (rotation * p) + translation; }
};

/// Iterated closest points [BeslMcKay92] from many starts: the frames as they are, the principal
/// axes with all their orders and signs, and turns drawn from `seed`, each with the sizes and
/// middles of both. Pairs go both ways, from the result to the truth and from the truth to the
/// result, so that nothing shrinks onto a part; of either a fifth, the farthest, does not count
/// [Chetverikov02]. The similarity of the rest is Umeyama's [Umeyama91]. The best start is refined
/// with more points; where both have faces, along the normals at the nearest points of these
/// [ChenMedioni92]. Of a symmetric object one of the equal answers. Same result whatever the number
/// of threads. Throws Error where either has no extent; Cancelled.
Alignment align(const TriMesh& result, const Truth& truth, std::uint64_t seed, Progress& progress);

/// The mesh moved, its origin and normals with it.
TriMesh moved(const TriMesh& mesh, const Alignment& alignment);

}  // namespace photohull::eval
