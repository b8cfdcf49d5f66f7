// The texture of a reconstruction, for the files that hold one.
#pragma once

#include "core/mesh_texture.h"
#include "pipeline/findings.h"
#include "pipeline/methods/method.h"

namespace photohull::pipeline {

/// Is a format among those asked for that holds a texture, and is one wanted?
bool makes_texture(const ReconstructOptions& options);

/// What the stage may take beside meshes, photographs and finished pages, of a job that may take
/// `limit`.
std::int64_t texture_bytes(std::int64_t limit);

struct MadeTexture {
  TexturedMesh mesh;
  TextureFindings findings;
};

/// The mesh for such files, with its texture. `uniform` has the colours of all voxels, `delivered`
/// is mesh.ply's: the mesh itself where fewer triangles were asked for. Else triangles are merged
/// here within a quarter of a voxel, for colours need no vertices any more. The photographs must
/// still have their pixels.
MadeTexture make_textured(const SurfaceJob& job, const TriMesh& uniform, const TriMesh& delivered);

/// The world axis, or the opposite of one, that the upper sides of most photographs point to; +z
/// where they point everywhere.
glm::dvec3 upward_axis(std::span<const PreparedView> views);

}  // namespace photohull::pipeline
