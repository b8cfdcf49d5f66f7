// How a map's texels are laid over what a viewpoint sees. Double precision, on the processor.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/box.h"
#include "core/camera.h"
#include "shared/visibility.h"
#include "visibility/technique.h"

namespace photohull::visibility {

/// One partition, for points relative to the geometry's origin; as shaders::MapProjection.
struct PartLayout {
  glm::dvec4 row_x, row_y, row_w, row_z;
  glm::dvec3 depth_of_w;  ///< depth = w * dot(depth_of_w, (X, Y, 1))
  double nearest_w = 0;   ///< nothing in front of it is drawn
  double end = 0;         ///< receivers' depth up to which it serves
};

struct MapLayout {
  glm::ivec2 size{0};  ///< texels of each partition
  std::vector<PartLayout> parts;
  glm::dvec4 eye_row{0.0};
  glm::dvec4 view_x{0.0}, view_y{0.0};
  double near = 0, far = 0;  ///< depths of the geometry's bounds, near > 0; far <= near: all behind
  double texel_width = 0;    ///< world units at depth 1, of the unwarped map
  bool warped = false;       ///< false where a warp fell back

  /// Middle of the range of depths, where biases in texels become lengths.
  double middle() const { return 0.5 * (near + far); }
};

/// `eye` is the receivers' camera, which warps need: without one, and where it sees nothing of
/// `bounds` or looks along the viewpoint's rays, the map is not warped. `bounds` in world
/// coordinates.
MapLayout lay_out(const Camera& viewpoint, const Box& bounds, const glm::dvec3& origin,
                  const Technique& technique, const std::optional<Camera>& eye);

/// Widths of biases included.
shaders::MapInfo to_info(const MapLayout& layout, const Technique& technique,
                         std::size_t triangles);

}  // namespace photohull::visibility
