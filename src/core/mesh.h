// Triangle meshes in world coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace photohull {

/// Counter-clockwise seen from outside. Attribute arrays are empty or as long as `positions`.
struct TriMesh {
  std::vector<glm::vec3> positions;  ///< world units, relative to `origin`
  glm::dvec3 origin{0.0};            ///< keeps float precision far from the world's origin
  std::vector<glm::vec3> normals;    ///< unit, outward
  std::vector<glm::vec3> colours;    ///< linear RGB
  std::vector<float> confidence;     ///< chance to lie within a voxel of the truth; 0: unseen
  std::vector<std::array<std::uint32_t, 3>> triangles;

  glm::dvec3 world(std::size_t vertex) const { return origin + glm::dvec3(positions[vertex]); }
};

}  // namespace photohull
