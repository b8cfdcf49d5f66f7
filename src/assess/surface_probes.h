// Points all over a reconstructed surface, and the views that see them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/silhouette.h"
#include "raycast/ray_scene.h"

namespace photohull::assess {

struct SurfaceProbe {
  glm::dvec3 point{0.0};   ///< world
  glm::dvec3 normal{0.0};  ///< unit, outward, of the triangle
  float confidence = 0;    ///< of the mesh at the point, [0, 1]
  std::vector<int> views;  ///< that see it, those it faces most first
};

/// `count` points, uniform over the mesh's area and the same in every run. A view sees a point when
/// the angle between normal and viewing direction is below 75 degrees, the point is on its image,
/// and nothing of the mesh hides the point lifted by `lift` (world units) along its normal. `mesh`
/// must have area and confidence; `rays` is made of it.
std::vector<SurfaceProbe> probe_surface(const TriMesh& mesh, const RayScene& rays,
                                        std::span<const Camera> cameras, std::size_t count,
                                        double lift);

}  // namespace photohull::assess
