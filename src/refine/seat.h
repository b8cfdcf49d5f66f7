// The surface seated on the outlines of silhouettes where photographs tell less.
#pragma once

#include <span>
#include <vector>

#include "core/describe.h"
#include "core/grid.h"
#include "refine/silhouette_cones.h"
#include "refine/surface.h"

namespace photohull::refine {

struct SeatOptions {
  int passes = 2;
  double reach = 1.5, margin = 0.4;
};

inline void describe(Described& to, SeatOptions& o) {
  to.number("passes", &o.passes, from_to(0, 100), "",
            "passes of finding contacts and moving towards them; 0: nothing is seated");
  to.number("reach", &o.reach, below(0, SparseVolume::kBand), "voxels",
            "distance that the surface may be short of an outline; as many pixels where these are "
            "larger");
  to.number("margin", &o.margin, from_to(0, 1), "voxels",
            "how far off interpolated distances to a curved hull may be");
}

/// How surely photographs tell the offsets of surfels, as seat_outlines takes it: `weights` that
/// are 1 at a standard deviation of a tenth of a voxel (0: none), averaged over the
/// surface around such that single surfels with strong claims among many without any count little.
std::vector<float> information_around(const VertexGraph& graph, std::span<const float> weights);

/// What is believed of each surfel.
struct SeatBeliefs {
  std::span<const float>
      information;               ///< how surely photographs tell its offset (information_around)
  std::span<const float> tight;  ///< chance in [0, 1] that surface lies on the hull here
};

/// Changes the displacements `moves` (voxels along the normals) of a mesh's vertices, on the hull's
/// grid, such that the moved surface touches the rays through the
/// silhouettes' outlines: least squares of what photographs tell (the moves as they come, by
/// `information`, see information_around) and of what silhouettes tell. Each ray touches the
/// object: the part of the surface that comes nearest to it has to, within the standard deviation
/// of the outline. Another part next to the ray may touch it, too, the less the farther it stands
/// behind the nearest, and the more the hull can be believed: `tight` in [0, 1] is the chance that
/// surface lies on it, by vertex (pull_to_hull gives it; less at thin parts, which hulls make too
/// thick). Surface that ends closer under the hull than photographs can tell, and than the hull's
/// distances are exact, is moved on beyond the hull: the caller intersects both.
void seat_outlines(const SparseVolume& hull, const SilhouetteCones& cones,
                   const MeshSurfels& surfels, const SeatBeliefs& beliefs,
                   const SeatOptions& options, std::vector<float>& moves);

}  // namespace photohull::refine
