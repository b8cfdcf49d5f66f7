// A mesh as points dense enough to hide what is behind it.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "projtex/photographs.h"
#include "visibility/kernels/depth_maps.h"

namespace photohull::render {

inline constexpr double kPointSpacing = 2.0;  ///< voxels; a quad's diagonal inside a voxel is less

/// A point of a surface.
struct SurfacePoint {
  glm::vec3 position{0};  ///< voxels
  glm::vec3 normal{0};    ///< outward; unit, or zero where unknown
};

/// The mesh's vertices in voxel coordinates.
std::vector<SurfacePoint> to_voxels(const GridSpec& grid, const TriMesh& mesh);
/// One of them.
SurfacePoint to_voxels(const GridSpec& grid, const TriMesh& mesh, std::size_t vertex);

/// Points on the triangles that have an edge longer than kPointSpacing, a voxel apart or less, with
/// normals across the triangles, of any length; the corners are left out.
std::vector<SurfacePoint> points_between(const TriMesh& mesh,
                                         std::span<const SurfacePoint> vertices);

/// Empty maps with texels wide enough (kBakeTexel) that every one within the mesh's outline holds a
/// point. `cut_at`: as visibility::DepthMaps has it.
visibility::DepthMaps occluder_maps(std::span<const Camera> cameras, const GridSpec& grid,
                                    int cut_at = 1);

}  // namespace photohull::render
