// A picture of where a reconstruction is off.
#pragma once

#include <string>

#include "core/mesh.h"
#include "core/progress.h"
#include "core/rgb_image.h"
#include "eval/truth.h"

namespace photohull::eval {

struct ErrorImageOptions {
  double range = 0;   ///< distance of the strongest colours, world units; > 0
  int panel = 480;    ///< edge of a view, pixels; in [64, 4096]
  std::string title;  ///< ASCII, drawn above the views
};

/// The result from the six directions of the world's axes, parallel projections framed on the
/// truth, in the colours of error_colour by the exact distance at every pixel, under a headlight;
/// and a legend. `result` must have faces. Throws Cancelled.
RgbImage draw_error_image(const TriMesh& result, const Truth& truth,
                          const ErrorImageOptions& options, Progress& progress);

}  // namespace photohull::eval
