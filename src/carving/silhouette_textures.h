// The silhouettes on the device, for hulls of any grid and box.
#pragma once

#include <vector>

#include "carving/hull.h"
#include "core/camera.h"
#include "gpu/texture.h"

namespace photohull::carving {

/// What the hull's kernels look at of each view, a layer a view: the pyramid of the least and the
/// greatest coverage (MaskPyramid), and signed distances to the outline in pixels. A context must
/// be current as long as it lives.
class SilhouetteTextures {
 public:
  /// Nothing of the views is kept but their cameras. Throws Error when the device cannot hold it.
  explicit SilhouetteTextures(const HullViews& views);

  const std::vector<Camera>& cameras() const { return cameras_; }
  int levels() const { return levels_; }  ///< of the pyramid
  glm::ivec2 size() const { return {distances_.width(), distances_.height()}; }
  const gpu::TextureArray& pyramid() const { return pyramid_; }
  const gpu::TextureArray& distances() const { return distances_; }

 private:
  std::vector<Camera> cameras_;
  int levels_ = 0;
  gpu::TextureArray pyramid_, distances_;
};

}  // namespace photohull::carving
