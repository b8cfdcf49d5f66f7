// The surface that is photographed.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/box.h"
#include "core/mesh.h"
#include "raycast/ray_scene.h"
#include "synth/spec.h"

namespace photohull::synth {

/// The exact surface: what the pictures show and what gt.ply holds. Faces meet smoothly where
/// their normals are within 30 degrees, and in a sharp edge otherwise.
struct Surface {
  TriMesh mesh;                                   ///< positions and triangles only
  Box box;                                        ///< tight, world
  double diagonal = 0;                            ///< of the box
  std::vector<glm::vec3> face_normals;            ///< unit; of every triangle
  std::vector<std::array<glm::vec3, 3>> normals;  ///< unit; of every triangle's corners
  std::vector<std::uint32_t> patches;             ///< of every triangle: its sharp-edged patch
  std::unique_ptr<RayScene> rays;

  /// Smooth normal at a hit, unit, on the side that the triangle's corners run around
  /// counter-clockwise.
  glm::vec3 normal(const Hit& hit) const;
};

/// Builds or reads the geometry. Throws Error naming the mesh file when it cannot be read, has no
/// faces or no area.
Surface make_surface(const GeometrySpec& geometry);

/// The same for a mesh at hand; `source` opens messages.
Surface make_surface(TriMesh mesh, const std::string& source);

}  // namespace photohull::synth
