// Meshes of parts that lie side by side made one, without a seam.
#pragma once

#include <cstddef>
#include <vector>

#include "core/mesh.h"

namespace photohull {

struct Stitched {
  TriMesh mesh;
  std::size_t seam_vertices = 0;  ///< each of vertices of two parts or more
  std::size_t filled = 0;         ///< gaps between parts, closed by triangles
  std::size_t open_edges = 0;     ///< that are left at the seam
};

/// Parts of one surface that each end where the next one begins, to within `reach` (world units, >
/// 0; less than the length of an edge): vertices at their borders that lie so near each other
/// become one in the middle, the nearest ones first, and never two of the same part. Gaps that are
/// left between parts, a few edges wide, are filled. Borders elsewhere stay as they are.
/// Attributes are those that all parts have; empty parts have a say in nothing.
Stitched stitch_parts(std::vector<TriMesh> parts, double reach);

}  // namespace photohull
