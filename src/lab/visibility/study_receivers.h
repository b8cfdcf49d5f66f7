// What a camera sees, as receivers of visibility. Private to the study.
#pragma once

#include <vector>

#include "lab/visibility/study.h"
#include "raycast/ray_scene.h"
#include "visibility/kernels/visibility_map.h"
#include "visibility/layout.h"

namespace photohull::visibility {

struct Receivers {
  std::vector<Sample> samples;      ///< that face the viewpoint
  std::vector<std::uint8_t> truth;  ///< 1: visible
  std::vector<int> pixel;           ///< row-major
};

/// First hits of the camera's rays at width x height, with the steps to the neighbouring pixels on
/// the triangle's plane. Normals face the camera; what faces away from the viewpoint is left out.
Receivers receivers_of(const RayScene& rays, const TriMesh& mesh, const Camera& viewpoint,
                       const Camera& camera, int width, int height);

VisibilityErrors errors_of(const std::vector<float>& found, const std::vector<std::uint8_t>& truth);

/// Short lines across silhouettes on the viewpoint's image, half before and half behind them.
class Silhouettes {
 public:
  /// Places where occlusion changes on rays that end at the far side of what `eye` sees of the
  /// scene's box.
  Silhouettes(const RayScene& rays, const Camera& viewpoint, const Box& bounds, const Camera& eye,
              int count, unsigned seed);
  /// Mean length, in texels of the plain map of `resolution`, over which a line was judged wrongly.
  double error(gpu::Context& context, const VisibilityMap& map, int resolution) const;

 private:
  struct Place {
    glm::dvec2 pixel;  ///< a silhouette passes here
    double depth;      ///< of the samples
  };
  Sample sample_at(const glm::dvec2& pixel, double depth) const;

  const RayScene& rays_;
  Camera viewpoint_;
  std::vector<Place> places_;
};

}  // namespace photohull::visibility
