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

/// Where patterns are fixed, and what they are large by: the surface before it was laid on another
/// side, or as it lies at the first frame of a sequence.
struct OwnFrame {
  glm::dmat3 rotation{1.0};  ///< own_from_world
  glm::dvec3 middle{0.0};    ///< about which it was turned: of the box before, world
  glm::dvec3 size{0.0};      ///< of the box before
  double diagonal = 0;       ///< of the box before

  glm::dvec3 place(const glm::dvec3& world) const { return rotation * (world - middle); }
};

/// The exact surface: what the pictures show and what gt.ply holds. Faces meet smoothly where
/// their normals are within 30 degrees, and in a sharp edge otherwise.
struct Surface {
  TriMesh mesh;                         ///< positions and triangles only
  Box box;                              ///< tight, world; around all frames where it moves
  double diagonal = 0;                  ///< of the box
  std::vector<glm::vec3> face_normals;  ///< unit; of every triangle
  std::vector<std::array<glm::vec3, 3>> normals;  ///< unit; of every triangle's corners
  std::vector<std::uint32_t> patches;             ///< of every triangle: its sharp-edged patch
  std::unique_ptr<RayScene> rays;
  OwnFrame own;
  bool moves = false;  ///< from frame to frame of a sequence

  /// Smooth normal at a hit, unit, on the side that the triangle's corners run around
  /// counter-clockwise.
  glm::vec3 normal(const Hit& hit) const;
};

/// Degrees about x, y and z, in that order.
glm::dmat3 turn_by(const glm::dvec3& degrees);

/// Around the vertices of all triangles, world.
Box tight_box(const TriMesh& mesh);

/// Builds or reads the geometry's mesh. Throws Error naming the mesh file when it cannot be read.
TriMesh make_mesh(const GeometrySpec& geometry);

/// Builds or reads the geometry. Throws Error naming the mesh file when it cannot be read, has no
/// faces or no area.
Surface make_surface(const GeometrySpec& geometry);

/// The same, turned about the middle of its box by degrees about x, y and z, in that order.
Surface make_surface(const GeometrySpec& geometry, const glm::dvec3& turn);

/// The same for a mesh at hand; `source` opens messages.
Surface make_surface(TriMesh mesh, const std::string& source);

}  // namespace photohull::synth
