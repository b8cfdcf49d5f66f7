// Textured meshes of GLB files, read by assimp.
#pragma once

#include <string>

#include "core/mesh_texture.h"

namespace photohull::texture {

/// Turned back into the world in which `up` is upward. Throws Error where it cannot be read, or has
/// no texture.
TexturedMesh read_textured(const std::string& path, const glm::dvec3& up);

}  // namespace photohull::texture
