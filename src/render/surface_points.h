// Private to module render: a mesh as points dense enough to hide what is behind it.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"

namespace photohull::render {

/// The voxels (xyz; w is 0) nearest to the mesh's vertices and, on triangles with an edge longer
/// than kPointSpacing voxels, to points in between that are no further apart.
std::vector<glm::ivec4> surface_points(const GridSpec& grid, const TriMesh& mesh);

inline constexpr double kPointSpacing = 2.0;  ///< voxels; a quad's diagonal inside a voxel is less

}  // namespace photohull::render
