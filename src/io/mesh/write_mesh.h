// Meshes in PLY files (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/mesh.h"

namespace photohull {

/// Scalar properties of a PLY's vertices that a TriMesh has no place for, by name; each holds one
/// value a vertex.
using VertexScalars = std::map<std::string, std::vector<double>>;

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

/// Reads a PLY, ascii or binary little-endian, with the properties that write_ply writes in any
/// order and any scalar type; other properties and elements are skipped, polygons become fans of
/// triangles. The mesh's origin is the middle of its bounds. Throws Error when the file cannot be
/// read, is no such PLY, ends early or has indices out of range. A file without faces gives its
/// points.
TriMesh read_ply(const std::filesystem::path& path);
/// The same, and the vertices' other scalar properties, such as `views`, replace `scalars`.
TriMesh read_ply(const std::filesystem::path& path, VertexScalars& scalars);

}  // namespace photohull
