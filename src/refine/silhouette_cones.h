// The silhouettes of a scene, with the cameras that saw them.
#pragma once

#include <algorithm>
#include <span>

#include "carving/hull.h"
#include "core/camera.h"
#include "core/depth_map.h"

namespace photohull::refine {

/// What bounds the object: silhouettes, one a camera. Parts may be empty.
struct SilhouetteCones {
  std::span<const Camera> cameras;
  std::span<const carving::Silhouette> silhouettes;
  /// Of each camera, in world units: what of the object covers its silhouette, and is not looked at
  /// itself. Empty: nothing does.
  std::span<const DepthMap> beside{};

  /// Is there a silhouette at all?
  bool any() const {
    return std::any_of(silhouettes.begin(), silhouettes.end(),
                       [](const carving::Silhouette& s) { return s.distance; });
  }
};

}  // namespace photohull::refine
