// Where rays through the outlines of silhouettes touch the surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "refine/silhouette_cones.h"

namespace photohull::refine {

/// A point of the surface's own outline in a view, next to the outline of the view's silhouette.
/// The ray through the latter touches the object somewhere [Cipolla00].
struct Contact {
  std::uint32_t a = 0, b = 0;  ///< ends of the edge of the mesh that it lies on
  float along = 0;             ///< from a to b, [0, 1]
  float lack = 0;              ///< voxels that the surface is short of the outline; below 0: beyond
  float least = 0;             ///< the least lack of all that lies at the same place of the outline
  float unsure = 0;            ///< voxels: standard deviation of the silhouette's outline
};

/// The contacts of a closed mesh, whose vertices' `positions` (voxels of `grid`) and outward unit
/// `normals` are given aside, with the silhouettes' outlines: all within `reach`
/// voxels, or pixels where these are larger, and less than SparseVolume::kBand voxels. Sharp edges
/// have contacts, too. Ordered by camera, then by triangle.
std::vector<Contact> find_contacts(const GridSpec& grid, const TriMesh& mesh,
                                   std::span<const glm::vec3> positions,
                                   std::span<const glm::vec3> normals, const SilhouetteCones& cones,
                                   double reach);

}  // namespace photohull::refine
