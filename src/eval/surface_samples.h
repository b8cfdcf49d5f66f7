// Points that stand for a surface.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/mesh.h"

namespace photohull::eval {

struct SurfaceSamples {
  std::vector<glm::dvec3> points;        ///< world
  std::vector<std::uint32_t> triangles;  ///< the face that each lies on; empty for points alone
  double area = 0;                       ///< of the whole surface, world units squared
};

/// `count` points, uniform over the area and stratified along the cumulative area of the triangles
/// in their order. Equal seeds give equal points. The mesh must have area.
SurfaceSamples sample_surface(const TriMesh& mesh, std::size_t count, std::uint64_t seed);

/// The vertices of a point cloud thinned to one centroid a cubic cell of edge `cell`, world units,
/// counted from the low corner of the bounds.
SurfaceSamples thin_points(const TriMesh& cloud, double cell);

}  // namespace photohull::eval
