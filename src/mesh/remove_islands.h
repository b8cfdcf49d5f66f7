// Pieces of an open mesh that too few photographs support, left out.
#pragma once

#include <cstddef>
#include <span>

#include "core/mesh.h"
#include "mesh/simplify_mesh.h"

namespace photohull {

struct IslandOptions {
  double voxel_size = 0;  ///< world units, > 0
  /// Voxels squared, of a piece and those in a row with it. A false match moves the surface within
  /// its patch and the averages around it, about six voxels along each side.
  double least_area = 36;
  /// Of the main piece's mean support, [0, 1]: what small pieces need, and large ones.
  double least_support = 0.5, least_support_large = 0.2;
  double large = 0.02;      ///< share of the main piece's area, from which on a piece is large
  double longest_gap = 16;  ///< voxels, in a row
};

struct RemovedIslands {
  std::size_t pieces = 0;
  double area_share = 0;  ///< of the mesh, [0, 1]
};

/// Removes connected pieces of the mesh that noise can have made. The support of a vertex is its
/// confidence times the number of views that see it beyond the first, for one view alone confirms
/// nothing; that of a piece is the mean by area. The main piece has the largest sum of it. A piece
/// stays whose mean support is at least the share of the main piece's that its size asks for, and
/// which has the least area together with what it is in a row with: pieces (the main one too) whose
/// gap to it is no longer than the smaller of both, as those of a thin part that is found in
/// dashes.
///
/// `views` counts, for each vertex, the views that see it. Vertices keep their attributes and
/// order; the lists of `more` lose the numbers of those that go. A mesh without triangles comes
/// back as it is. Throws UsageError unless voxel_size > 0.
RemovedIslands remove_islands(TriMesh& mesh, std::span<const float> views,
                              const IslandOptions& options, MoreNumbers more = {});

}  // namespace photohull
