// Meshes as their files list them. Internal to io/mesh.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace photohull {

/// World positions and triangles before vertices at the same position are joined. All indices are
/// below the number of positions.
struct Soup {
  std::vector<glm::dvec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Throws the Error that a mesh file cannot be read: the file, what was found, the mend.
[[noreturn]] void fail_to_read(const std::filesystem::path& path, const std::string& what,
                               const std::string& mend);

/// Reads an OFF file in ASCII, with a line for each vertex and each face (as all programs write
/// them); what follows the coordinates (normals, colours) and the indices (colours) is left out.
/// Polygons become fans. Throws Error.
Soup read_off(const std::filesystem::path& path);

/// Reads the triangles of a glTF 2.0 file's scene (all meshes where it has none), or of a binary
/// one, with the transforms of the nodes applied; buffers in the file, beside it or as base64.
/// Throws Error for what it does not read: sparse and quantised positions, and required extensions.
Soup read_gltf(const std::filesystem::path& path);

}  // namespace photohull
