// Meshes in PLY files (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/atomic_file.h"
#include "core/mesh.h"
#include "io/read_ply.h"

namespace photohull {

/// What all vertices of a mesh have, and how many there are.
struct PlyLayout {
  bool normals = false, colours = false, confidence = false;
  bool doubles = false;  ///< would floats move vertices by more than a thousandth of an edge?
  std::size_t vertices = 0, triangles = 0;
};
PlyLayout ply_layout(const TriMesh& mesh);

/// A PLY as write_ply makes it, for the caller to commit, from meshes that are in memory one after
/// the other: all vertices, then all triangles. Attributes that the layout has not are left out.
/// Throws Error when the file cannot be written.
class PlyFile {
 public:
  PlyFile(AtomicFile& file, const PlyLayout& layout);
  void add_vertices(const TriMesh& mesh);
  /// Of vertices by their numbers in the file.
  void add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles);

 private:
  AtomicFile& file_;
  const PlyLayout layout_;
};

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
