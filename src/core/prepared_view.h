// A photograph that is ready for carving.
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/scene.h"
#include "core/silhouette.h"

namespace photohull {

/// What carving goes by of a view. Without a mask all of it is empty.
struct ViewSilhouette {
  SilhouetteDistance distance;   ///< of `widened` where there is one, else of the mask
  std::vector<LinePoint> lines;  ///< parts of the mask narrower than about two pixels
  /// The mask with room around its lines and its outline, and with what other views put into it;
  /// empty where nothing changed.
  Mask widened;
  /// Coverage is the chance that the object is there (masks that were made from the background),
  /// not the share of a pixel.
  bool likelihood = false;
};

/// A photograph ready for carving: undistorted, with its mask.
struct PreparedView {
  std::string name;
  Camera camera;  ///< pinhole; intrinsics match the image's size
  ColourImage image;
  Mask mask;
  /// Share of fine detail beside views of the same (views/sharpness.h): 1 as sharp as they are.
  double sharpness = 1;
  SourceView source{};  ///< the photograph as the scene lists it, at the scale that it was read at
  double scale = 1;     ///< that: of the file's size, (0, 1]
  double matched_scale = 1;  ///< larger where only some photographs are held as large at a time
  ViewSilhouette silhouette{};
};

}  // namespace photohull
