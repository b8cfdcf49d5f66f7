// Private to module refine: the views that a view's rays are matched with.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "core/box.h"
#include "projtex/gpu_views.h"
#include "refine/view_choice.h"

namespace photohull::refine {

/// The views that one view's rays are matched with: a choice for each of its tiles, for what is
/// seen in different parts of a photograph may be on the images of different neighbours.
struct ViewPartners {
  int across = 1;                 ///< tiles along either side
  std::vector<ViewChoice> tiles;  ///< row-major

  /// Of the ray at (x, y) on a lattice of width x height rays over the image.
  int tile(int x, int y, int width, int height) const {
    return y * across / height * across + x * across / width;
  }
};

/// For every view itself and then views near it, at angles between them, `nearest` degrees at
/// least, that are seen from the middle of the box (voxels). With several `tiles` along either side
/// of the views, others are chosen for a tile where not all of these have on their images what it
/// looks at, or where the view stands within the box: views that have it, at angles seen from
/// there.
std::vector<ViewPartners> choose_partners(std::span<const projtex::GridCamera> cameras,
                                          const Box& box, double nearest, int tiles);

}  // namespace photohull::refine
