// A mesh to the signed distance from it.
#pragma once

#include <cstddef>
#include <span>

#include "core/grid.h"
#include "core/mesh.h"

namespace photohull {

inline constexpr std::size_t kSlabVertices = std::size_t(1) << 19;  ///< 130 MiB of points and lists

/// Truncated signed distance (voxels) from a closed mesh with normals on the voxels of `grid`: from
/// the tangent planes of the points nearest to a voxel, blended where they look the same way, up to
/// `reach` voxels (at most kBand) from the surface; beyond, -kBand or kBand.
///
/// `sides` is the volume that the mesh is the surface of, on any grid that covers the same space:
/// a voxel of `grid` keeps the side that it has there wherever that surface is a voxel of `sides`
/// or more away, whatever the planes say, and so do bricks that the mesh does not reach.
///
/// Triangles may fold and meet; parts outside the grid are cut off. Time grows with the surface.
/// The mesh is taken in slabs of about `at_once` vertices, which bounds memory and changes nothing
/// of the result.
SparseVolume distance_from_mesh(const TriMesh& mesh, const SparseVolume& sides,
                                const GridSpec& grid, double reach = SparseVolume::kBand,
                                std::size_t at_once = kSlabVertices);

/// Moves the surface of `volume` along its normal by `displacement` (voxels, positive outward, less
/// than kBand) of the vertices of its own mesh (with normals), spread to the voxels around them as
/// above. Only stored bricks change, and their values are no exact distances afterwards.
void move_surface(SparseVolume& volume, const TriMesh& mesh, std::span<const float> displacement,
                  std::size_t at_once = kSlabVertices);

}  // namespace photohull
