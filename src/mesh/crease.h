// Private to module mesh: the two or three smooth surfaces that meet at a crease.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/sharpen_edges.h"

namespace photohull {

/// A mesh to look for creases in. Lengths are in units of what the surface resolves.
struct CreaseMesh {
  std::span<const glm::dvec3> positions;
  std::span<const glm::vec3> normals;  ///< unit
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> first, faces;  ///< those around vertex i: faces[first[i]] and on
  std::vector<std::uint8_t> rounded;        ///< vertices whose surroundings a crease may have bent

  std::span<const std::uint32_t> around(std::size_t vertex) const {
    return {faces.data() + first[vertex], first[vertex + 1] - first[vertex]};
  }
};

/// A smooth surface beside a crease: a height of second order over the plane of u and v. Points
/// are relative to the vertex that it was fitted for.
class Flank {
 public:
  /// Fits the vertices `support` around vertex `centre`; false where they do not face one way.
  bool fit(const CreaseMesh& mesh, std::uint32_t centre, std::span<const std::uint32_t> support);

  /// Signed distance, to first order.
  double distance(const glm::dvec3& p) const;
  /// Unit, outward.
  glm::dvec3 normal(const glm::dvec3& p) const;
  /// Root mean square of the angle to the vertices' normals, radians.
  double roughness() const { return roughness_; }

 private:
  double height(double x, double y) const;

  glm::dvec3 u_{0.0}, v_{0.0}, n_{0.0};
  std::array<double, 6> c_{};
  double roughness_ = 0;
};

/// The point where one, two or three flanks meet that is nearest to `point`, to second order. Stays
/// where they hardly turn.
glm::dvec3 meeting_point(std::span<const Flank* const> flanks, glm::dvec3 point);

/// What lies around a vertex.
struct Crease {
  enum class Finding { kUnknown, kNone, kFound };

  Finding finding = Finding::kUnknown;  ///< does the surface turn sharply between smooth flanks?
  int flanks = 0;                       ///< 2 or 3, whatever was found; else 0
  std::array<Flank, 3> flank;
};

/// Room for find_crease; one per thread, for one mesh.
struct CreaseScratch {
  std::vector<std::uint32_t> visit, ball;
  std::vector<std::int8_t> part;
  std::array<std::vector<std::uint32_t>, 3> support;
};

/// Looks at vertex `centre`: the mesh within reach of it, less what is rounded, falls into
/// connected parts, which are the flanks.
Crease find_crease(const CreaseMesh& mesh, std::uint32_t centre, const SharpenOptions& options,
                   CreaseScratch& scratch);

}  // namespace photohull
