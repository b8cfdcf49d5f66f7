// Meshes and points from PLY files (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace photohull {

/// Scalar properties of a PLY's vertices that a TriMesh has no place for, by name; each holds one
/// value a vertex.
using VertexScalars = std::map<std::string, std::vector<double>>;

/// Reads a PLY, ascii or binary little-endian, with the properties that write_ply writes in any
/// order and any scalar type; other properties and elements are skipped, polygons become fans of
/// triangles. The mesh's origin is the middle of its bounds. Throws Error when the file cannot be
/// read, is no such PLY, ends early or has indices out of range. A file without faces gives its
/// points.
TriMesh read_ply(const std::filesystem::path& path);
/// The same, and the vertices' other scalar properties, such as `views`, replace `scalars`.
TriMesh read_ply(const std::filesystem::path& path, VertexScalars& scalars);

}  // namespace photohull
