// Meshes as files with textures list them: a vertex for every place that it has on a page. Internal
// to io/mesh.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/mesh_texture.h"
#include "io/mesh/mesh_writers.h"

namespace photohull {

/// The triangles of one page, or all of a mesh without texture.
struct MeshPart {
  std::vector<std::uint32_t> vertices;  ///< of the mesh, for each vertex of the part
  std::vector<glm::vec2> places;        ///< of them on the page; empty without texture
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of the part's vertices
};

/// One part a page, in their order; vertices ascend. Parts may be empty.
std::vector<MeshPart> split_by_pages(const MeshContents& contents);

/// Takes world coordinates to those in which `up` is +Y: a turn by quarters.
glm::dmat3 y_up_from_world(const glm::dvec3& up);

/// The vertex's normal, or one that is any but of unit length where it has none.
glm::vec3 unit_normal(const TriMesh& mesh, std::size_t vertex);

/// "mesh_0.png", for a mesh in mesh.obj.
std::string page_name(const AtomicFile& file, std::size_t page, TextureFormat format);

}  // namespace photohull
