// Closed surfaces from formulas. Internal to synth.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "core/mesh.h"

namespace photohull::synth {

/// Puts closed parts into one mesh. Every part comes out with its triangles counter-clockwise seen
/// from outside, whatever the handedness of its formula; parts must not meet.
class MeshBuilder {
 public:
  /// A point of a grid: row in [0, rows], column in [0, columns).
  using Grid = std::function<glm::dvec3(int row, int column)>;

  /// A sphere's topology: rows 0 and `rows` are poles (asked for column 0 only), columns close.
  void add_sphere_like(int rows, int columns, const Grid& point);
  /// A torus's topology: rows and columns close, row in [0, rows).
  void add_torus_like(int rows, int columns, const Grid& point);
  /// A profile (radius, height) turned about the z axis; its first and last radius are 0.
  void add_revolution(const std::vector<glm::dvec2>& profile, int columns);
  /// A simple polygon (any sense, convex or not) swept from `low` to `high`, placed by
  /// `place(x, y, height)`.
  void add_extrusion(const std::vector<glm::dvec2>& polygon, double low, double high,
                     const std::function<glm::dvec3(const glm::dvec3&)>& place);
  void add_box(const glm::dvec3& low, const glm::dvec3& high);
  /// A box of air within what was added: its triangles look inwards.
  void add_hollow(const glm::dvec3& low, const glm::dvec3& high);
  /// A tube with round ends about a curve; `center(s)` and `radius(s)` for s in [0, 1]. The
  /// curve must not run along `side`, and the tube not meet itself.
  void add_tube(const std::function<glm::dvec3(double)>& center,
                const std::function<double(double)>& radius, int steps, int columns,
                const glm::dvec3& side);
  /// A ready closed part.
  void add_part(const std::vector<glm::dvec3>& points,
                const std::vector<std::array<std::uint32_t, 3>>& triangles);

  TriMesh take() { return std::move(mesh_); }

 private:
  TriMesh mesh_;
};

/// Triangles of a simple polygon, by clipping ears; counter-clockwise where the polygon is.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<glm::dvec2>& polygon);

}  // namespace photohull::synth
