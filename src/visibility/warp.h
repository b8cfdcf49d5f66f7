// Warps of a map in its own plane. Private to visibility.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/camera.h"
#include "visibility/technique.h"

namespace photohull::visibility {

/// From homogeneous texel positions of the plain map, (X z, Y z, z), to those of the warped one,
/// (x, y, w); w is positive on the region, about z in its nearest part.
using WarpMatrix = glm::dmat3;

/// What a map is asked for: the corners of the region that the receivers' camera sees.
struct WarpRegion {
  std::vector<glm::dvec2> texels;          ///< on the plain map
  std::vector<double> depths;              ///< before the receivers' camera, > 0
  glm::dvec2 near_end{0.0}, far_end{0.0};  ///< of that camera's axis within the region, texels
  double sine = 0;        ///< of the angle between that axis and the viewpoint's rays; 0: no axis
  double limit_sine = 0;  ///< below this a general warp fades
};

/// The region's bounding rectangle onto [margin, size - margin].
WarpMatrix fit_region(const WarpRegion& region, const glm::ivec2& size, double margin);

/// A trapezoid about the region [MartinTan04] with the distance n' of light-space perspective maps
/// [Wimmer04] from its short base to the projection's centre. kLispsm: n' = (z_n + sqrt(z_n z_f)) /
/// sin, in the map's plane. kGeneralLispsm: as much warp as the depths at the two bases call for,
/// whatever the angle, fading below limit_sine [Lloyd06]. The opening is limited by a greater n'.
/// Falls back to fit_region where the axis is a point on the map; `warped` tells.
WarpMatrix warp_region(const WarpRegion& region, const glm::ivec2& size, double margin, Warp warp,
                       bool& warped);

}  // namespace photohull::visibility
