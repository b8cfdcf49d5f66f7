// The photographs on the device.
#pragma once

#include <span>

#include "core/image.h"
#include "gpu/texture.h"

namespace photohull::projtex {

/// All images as layers of one array texture with mip chains, sampled to linear light. 8-bit images
/// stay 8-bit sRGB; one image of higher precision makes the whole set half float.
/// Images smaller than the array repeat their border in the unused part, so that no mip level mixes
/// anything foreign into them.
class ImageSet {
 public:
  /// Throws Error when the device cannot hold the images.
  explicit ImageSet(std::span<const View> views);

  const gpu::TextureArray& texture() const { return texture_; }
  int layers() const { return texture_.layers(); }

 private:
  gpu::TextureArray texture_;
};

}  // namespace photohull::projtex
