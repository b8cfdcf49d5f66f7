// Meshes of parts that lie side by side made one, without a seam, with one of them in memory at a
// time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace photohull {

/// A part's border and what is near it: all that joining looks at. Triangles that joining may drop
/// have a vertex on the border; all others at their vertices are there, too.
struct Rim {
  TriMesh mesh;
  std::vector<std::uint32_t> vertices;   ///< of the part, in order: those that `mesh` has
  std::vector<bool> border;              ///< of each of them: does it lie on the border?
  std::vector<std::uint32_t> triangles;  ///< of the part, in order: those that `mesh` has
  std::uint32_t part_vertices = 0, part_triangles = 0;  ///< how many the part has
};
Rim rim_of(const TriMesh& part);

/// What becomes of a part's vertices and triangles.
struct StitchedPart {
  std::uint32_t first = 0;           ///< number of its first vertex in the joined mesh
  std::vector<std::uint32_t> gone;   ///< its vertices that are left out, in order
  std::vector<std::uint32_t> moved;  ///< its vertices that are of several parts, in order
  TriMesh places;                    ///< the vertices that these become
  std::vector<std::uint32_t> rim;    ///< its triangles that Stitched::rim is in place of, in order
};

struct Stitched {
  std::vector<StitchedPart> parts;
  std::vector<std::array<std::uint32_t, 3>> rim;  ///< triangles of vertices of the joined mesh
  std::size_t vertices = 0, triangles = 0;        ///< of the joined mesh
  std::size_t seam_vertices = 0;                  ///< each of vertices of two parts or more
  std::size_t filled = 0;                         ///< gaps between parts, closed by triangles
  std::size_t open_edges = 0;                     ///< that are left at the seam
};

/// Parts of one surface that each end where the next one begins, to within `reach` (world units, >
/// 0; less than the length of an edge): vertices at their borders that lie so near each other
/// become one in the middle, the nearest ones first, and never two of the same part. Gaps that are
/// left between parts, a few edges wide, are filled; open pieces as small go, which the part
/// beside theirs has none of. Borders elsewhere stay as they are.
/// Attributes are those that all parts have; empty parts have a say in nothing.
Stitched stitch_rims(std::vector<Rim> rims, double reach);

/// The part's vertices that the joined mesh has, in order, and its triangles but for the rim's, of
/// vertices of the joined mesh.
TriMesh joined_part(const StitchedPart& part, TriMesh mesh);

}  // namespace photohull
