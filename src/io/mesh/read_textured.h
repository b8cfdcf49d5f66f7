// Meshes with a texture, as write_glb writes them.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>

#include "core/mesh_texture.h"

namespace photohull {

/// Reads back the mesh and the texture of a GLB file that write_glb wrote, in world coordinates;
/// `up` is the world axis that became +Y. Vertices that lie at several places of the texture come
/// several times; compressed ones are within the steps of that. Throws Error where the file is none
/// that write_glb wrote with a texture, or is damaged.
TexturedMesh read_textured_glb(const std::filesystem::path& path, const glm::dvec3& up);

}  // namespace photohull
