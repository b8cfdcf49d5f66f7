// Rays against triangle meshes, through Embree [Wald14].
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "core/mesh.h"

namespace photohull {

/// Points origin + t * direction, tnear <= t <= tfar, in world coordinates. The direction need not
/// be of unit length; t counts in its lengths.
struct Ray {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};
  double tnear = 0;
  double tfar = std::numeric_limits<double>::infinity();
};

/// Where a ray meets a triangle (a, b, c): at (1 - u - v) a + u b + v c.
struct Hit {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::uint32_t triangle = kNone;  ///< index into TriMesh::triangles
  double u = 0, v = 0;             ///< barycentric coordinates, in [0, 1] to rounding
  double t = 0;                    ///< along the ray, in lengths of its direction

  explicit operator bool() const { return triangle != kNone; }
};

/// A mesh ready for rays, whose triangles must stay in place as long as it lives. Both sides of a
/// triangle are hit, and no ray slips through the edge between two (Embree's robust mode).
/// Coordinates are single precision relative to the mesh's origin, so t is good to about 1e-6 of
/// the distances involved. Answers are the same in every run and from every number of threads;
/// const calls may run in parallel.
class RayScene {
 public:
  /// Throws Error when the mesh has no triangle, a coordinate that is not finite, or does not fit
  /// into memory. Indices must be in range.
  explicit RayScene(const TriMesh& mesh);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// The first hit along the ray, or nothing.
  std::optional<Hit> closest(const glm::dvec3& origin, const glm::dvec3& direction,
                             double tnear = 0,
                             double tfar = std::numeric_limits<double>::infinity()) const;
  /// Is there any hit?
  bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double tnear = 0,
                double tfar = std::numeric_limits<double>::infinity()) const;

  /// The same for many rays, several times faster where neighbours in the span lie close together;
  /// `hits` and `blocked` are as long as `rays`. A miss is a Hit without triangle.
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;

 private:
  struct Device;
  std::unique_ptr<Device> device_;
  glm::dvec3 origin_;
};

}  // namespace photohull
