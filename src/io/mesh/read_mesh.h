// Meshes in the files that people have them in.
#pragma once

#include <filesystem>

#include "core/mesh.h"

namespace photohull {

enum class Faces {
  kNeeded,   ///< a file without faces is an error
  kOptional  ///< a file without faces gives its points
};

/// Reads a mesh by its file's extension, in any case of letters:
///
///   .ply          as read_ply does: with normals, colours and confidence, in doubles where the
///                 file has them
///   .off          positions and faces only, in ASCII
///   .glb .gltf    positions and triangles only, transforms of nodes applied
///   .obj .stl     through assimp: positions and faces only, as floats
///
/// Polygons become fans of triangles, as in read_ply; but for .ply, vertices at the same position
/// are joined. The mesh's origin is the middle of its bounds; coordinates are the file's own (glTF
/// stays y-up). Throws Error naming the file when it cannot be read, has another extension, no
/// vertices, no faces where they are needed, positions that are no numbers below 1e30, or indices
/// out of range.
TriMesh read_mesh(const std::filesystem::path& path, Faces faces = Faces::kNeeded);

}  // namespace photohull
