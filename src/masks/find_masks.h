// Masks made from the background.
#pragma once

#include <functional>

#include "masks/masks.h"

namespace photohull {

/// Gives masks to the views that have none and may have one: from their plate where the scene names
/// one, else from a model of the background's colours over all such views; rather none than bad
/// ones. Sets their origins and how sure they are, and warns of those that are not. `cut`:
/// GrabCut places contours. Views are not undistorted yet. Throws Error for plates of the wrong
/// size and what the loader throws.
void find_masks(const Scene& scene, const ViewLoader& loader, bool cut,
                std::vector<MaskOrigin>& origins, PreparedViews& prepared);

/// find_masks, or what else comes to the same.
using MaskFinder = std::function<void(const Scene& scene, const ViewLoader& loader, bool cut,
                                      std::vector<MaskOrigin>& origins, PreparedViews& prepared)>;

}  // namespace photohull
