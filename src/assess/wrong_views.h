// Views whose silhouettes cannot be right, found before anything is carved.
#pragma once

#include <span>
#include <vector>

#include "core/box.h"
#include "core/camera.h"
#include "core/silhouette.h"

namespace photohull::assess {

/// With right cameras and masks the visual hull fills every silhouette [Laurentini94].
struct SilhouetteConsistency {
  double uncovered = 0;       ///< share of the silhouettes' rays that no point of the hull is on
  std::vector<int> wrong;     ///< views without which the others agree, in ascending order
  double uncovered_left = 0;  ///< share without those
};

/// Follows some hundred rays of each silhouette through the box and asks whether any point of them
/// lies on the silhouettes of all other views, two pixels aside allowed (more in images larger
/// than 200 pixels). Where more than two rays in a thousand hold no such point, views whose removal
/// gives most of them one are taken out one after the other, up to a quarter of them, as long as
/// one stands out from the others; they count as wrong if that mends most of it. Rays that show
/// what stands beside the box do not count. `silhouettes` holds a distance or nullptr for each
/// view.
SilhouetteConsistency find_wrong_views(const Box& box, std::span<const Camera> cameras,
                                       std::span<const SilhouetteDistance* const> silhouettes);

}  // namespace photohull::assess
