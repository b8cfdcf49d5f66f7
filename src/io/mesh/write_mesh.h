// Meshes in PLY files (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <filesystem>

#include "core/atomic_file.h"
#include "core/mesh.h"
#include "io/read_ply.h"

namespace photohull {

/// Writes a binary little-endian PLY in world coordinates. Vertex properties: x y z (float; double
/// when a float would move vertices by more than a thousandth of the mean edge), and where the mesh
/// has them nx ny nz (float), red green blue (uchar, sRGB) and confidence (float). Faces are lists
/// (uchar, int) `vertex_indices`. The file appears whole or not at all; throws Error when it cannot
/// be written.
void write_ply(const std::filesystem::path& path, const TriMesh& mesh);
/// The same, for the caller to commit.
void write_ply(AtomicFile& file, const TriMesh& mesh);
/// The same, and each of `scalars` becomes a further float property of the vertices; at most four,
/// each as long as mesh.positions.
void write_ply(const std::filesystem::path& path, const TriMesh& mesh,
               const VertexScalars& scalars);
void write_ply(AtomicFile& file, const TriMesh& mesh, const VertexScalars& scalars);

}  // namespace photohull
