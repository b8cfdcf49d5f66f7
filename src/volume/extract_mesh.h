// The surface of a volume as triangles.
#pragma once

#include <cstdint>
#include <span>

#include "core/grid.h"
#include "core/mesh.h"

namespace photohull {

/// The zero level set of the volume's distance as a mesh in world coordinates, relative to the
/// centre of the grid's bounds. Triangles are counter-clockwise seen from outside, and normals are
/// unit and point outward. The mesh is closed: what lies outside the grid counts as outside, so a
/// body that the grid's border cuts gets a flat face there. Colours and confidence stay empty.
///
/// Every voxel that the surface crosses gets a vertex; but in bricks flagged in `coarse` (one flag
/// per brick of the grid, or none at all) neighbourhoods of up to 8^3 voxels whose normals agree to
/// within 8 degrees share one. An empty volume gives an empty mesh.
TriMesh extract_mesh(const SparseVolume& volume, std::span<const std::uint8_t> coarse = {});

/// Moves the vertices of a mesh of this volume's surface onto the zero of the distance (one step of
/// Newton's along the gradient, at most a quarter voxel) and sets their outward unit normals: the
/// gradient by central differences, interpolated at the vertex. Where the distance does not tell
/// (at the grid's border, where it is flat, or against the faces) a vertex stays and its normal is
/// the area-weighted mean of the faces around it. Replaces mesh.normals.
void refine_vertices(const SparseVolume& volume, TriMesh& mesh);

}  // namespace photohull
