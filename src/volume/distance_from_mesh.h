// A mesh to the signed distance from it.
#pragma once

#include <span>

#include "core/grid.h"
#include "core/mesh.h"

namespace photohull {

/// Truncated signed distance (voxels) from a closed mesh with normals on the voxels of `grid`: from
/// the tangent planes of the points nearest to a voxel, blended where they look the same way, up to
/// `reach` voxels from the surface; beyond, inside or outside by what is nearest. Triangles may
/// fold and meet; parts outside the grid are cut off. Time grows with the surface.
SparseVolume distance_from_mesh(const TriMesh& mesh, const SparseVolume& sides,
                                const GridSpec& grid, double reach = SparseVolume::kBand);

/// Moves the surface of `volume` along its normal by `displacement` (voxels, positive outward) of
/// the vertices of its own mesh, spread to the voxels around them as above.
void move_surface(SparseVolume& volume, const TriMesh& mesh, std::span<const float> displacement);

}  // namespace photohull
