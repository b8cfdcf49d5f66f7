// Meshes in PLY files (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <filesystem>

#include "core/atomic_file.h"
#include "core/mesh.h"

namespace photohull {

/// Writes a binary little-endian PLY in world coordinates. Vertex properties: x y z (float; double
/// when a float would move vertices by more than a thousandth of the mean edge), and where the mesh
/// has them nx ny nz (float), red green blue (uchar, sRGB) and confidence (float). Faces are lists
/// (uchar, int) `vertex_indices`. The file appears whole or not at all; throws Error when it cannot
/// be written.
void write_ply(const std::filesystem::path& path, const TriMesh& mesh);
/// The same, for the caller to commit.
void write_ply(AtomicFile& file, const TriMesh& mesh);

/// Reads a PLY, ascii or binary little-endian, with the properties that write_ply writes in any
/// order and any scalar type; other properties and elements are skipped, polygons become fans of
/// triangles. The mesh's origin is the middle of its bounds. Throws Error when the file cannot be
/// read, is no such PLY, ends early or has indices out of range.
TriMesh read_ply(const std::filesystem::path& path);

}  // namespace photohull
