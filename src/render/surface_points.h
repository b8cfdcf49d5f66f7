// A mesh as points dense enough to hide what is behind it.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "shared/bake.h"
#include "visibility/depth_maps.h"

namespace photohull::render {

inline constexpr double kPointSpacing = 2.0;  ///< voxels; a quad's diagonal inside a voxel is less

/// The mesh's vertices in voxel coordinates, as the kernels take them.
std::vector<shaders::BakeVertex> to_voxels(const GridSpec& grid, const TriMesh& mesh);
/// Of `count` vertices from `first` on.
std::vector<shaders::BakeVertex> to_voxels(const GridSpec& grid, const TriMesh& mesh,
                                           std::size_t first, std::size_t count);

/// Points on the triangles that have an edge longer than kPointSpacing, a voxel apart or less, with
/// the triangles' own normals; the corners are left out.
std::vector<shaders::BakeVertex> points_between(const TriMesh& mesh,
                                                const std::vector<shaders::BakeVertex>& vertices);

/// Empty maps with texels wide enough (kBakeTexel) that every one within the mesh's outline holds a
/// point.
visibility::DepthMaps occluder_maps(std::span<const Camera> cameras, const GridSpec& grid);

}  // namespace photohull::render
