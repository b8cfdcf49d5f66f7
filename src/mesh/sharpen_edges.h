// Sharp edges that reconstruction rounds off.
#pragma once

#include <cstddef>

#include "core/mesh.h"

namespace photohull {

/// Lengths are in units of the surface's detail, see sharpen_edges.
struct SharpenOptions {
  bool on = true;
  double bend = 0.15;  ///< between neighbours' normals from which surface may be a rounded edge,
                       ///< radians a length; > 0
  double reach = 10;   ///< from a vertex within which the flanks of an edge are fitted; [3, 30]
  double most_turn = 120;  ///< between flanks, degrees; (0, 120]
  double distinct = 25;    ///< least turn over the flanks' own roughness; >= 0
  double rounding = 3;     ///< largest radius by which an edge may be rounded; >= 0
  double share = 0.6;      ///< of an edge's places that must show it; [0, 1]
  double shortest = 16;    ///< length of an edge; >= 0

  /// Throws UsageError naming the option.
  void validate() const;
};

/// Makes edges and corners of an extracted surface sharp where the smooth surfaces on either side,
/// fitted beside the edge and extended, meet near it, and where that shows along the whole edge
/// against the roughness of these surfaces. Vertices near an edge move onto the extended surfaces
/// or, where they part the triangles of two or three, onto the line or the point where these meet
/// [Kobbelt01; Ju02]; edges of triangles follow the line. Triangles stay the same, and what would
/// fold or degenerate stays in its place. Real roundings of radii up to about `rounding` become
/// sharp too: an extracted surface does not tell them from sharp edges.
///
/// `voxel_size` is that of the volume that `mesh` was extracted from, and `detail` the length of
/// what the surface resolves, not less: both in world units, > 0. Needs normals; moved vertices get
/// new ones. Returns how many vertices moved. The same mesh gives the same result with any number
/// of threads.
std::size_t sharpen_edges(const SharpenOptions& options, double voxel_size, double detail,
                          TriMesh& mesh);

}  // namespace photohull
