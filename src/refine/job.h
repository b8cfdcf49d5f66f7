// What all stages of a refinement work with; private to module refine.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "gpu/context.h"
#include "projtex/out_of_core.h"
#include "projtex/photographs.h"
#include "refine/bounding_hull.h"
#include "refine/match.h"
#include "refine/matching_photographs.h"
#include "refine/refine.h"
#include "refine/settle.h"
#include "refine/shared_work.h"
#include "refine/silhouette_cones.h"
#include "refine/view_choice.h"

namespace photohull::refine {

struct RefineJob {
  gpu::Context& context;
  const HullAt& hull_at;
  SilhouetteCones cones;
  projtex::Photographs photographs;
  RefineOptions options;
  double finest_voxel = 0;  ///< of the last level; world units
  /// Of the same views, larger, for voxels that those do not suffice for; null: there are none.
  projtex::OutOfCorePhotographs* larger = nullptr;

  SharedWork* shared = nullptr;  ///< by way of which other processes may help; null: none does
  bool is_part = false;          ///< of a whole, whose surface it starts from

  /// What surfels of the grid are matched in.
  MatchingPhotographs matching(const GridSpec& grid) const;
  bool matches_larger(const GridSpec& grid) const;
  /// Of the largest photographs.
  std::span<const Camera> finest_cameras() const {
    return larger ? larger->cameras() : photographs.cameras;
  }
  /// Is what silhouettes leave, and photographs do not tell of, solid?
  bool is_bounded() const { return options.bounded && cones.any(); }
};

/// What the photographs say of the surface that the last step of matching found: surfels with the
/// weights of their peaks, as fill_unproven takes them.
struct Proof {
  std::vector<glm::vec3> positions, normals;
  std::vector<float> weights;
};

/// What of the volume lies in the hull, without space that nothing can have looked into.
SparseVolume bounded(const SparseVolume& volume, const SparseVolume& hull);
/// The same, with a hull that is looked up again should the volume reach where it was dropped.
SparseVolume bounded(const RefineJob& job, const SparseVolume& volume, BoundingHull& hull);

/// Vertices in voxels of the grid.
std::vector<glm::vec3> voxel_positions(const GridSpec& grid, const TriMesh& mesh);

/// What was freed goes back to the system, where it is worth the time: the trees that meshes are
/// extracted from leave holes all over.
void give_back(const TriMesh& mesh);

/// The mesh's vertices matched as surfels, some of them after the others: PatchMatcher::match.
Matches match_vertices(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                       std::span<const glm::vec3> bends, std::span<const ViewChoice> choices,
                       const OffsetRange& range);
/// PatchMatcher::textures of the same.
Matches vertex_textures(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                        std::span<const ViewChoice> choices);

}  // namespace photohull::refine
