#include "carving/silhouette_textures.h"

#include <Imath/half.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>

#include "carving/mask_pyramid.h"
#include "core/error.h"
#include "projtex/gpu_views.h"

namespace photohull::carving {
namespace {

// Pixels of the views that are made ready at a time, before they are uploaded: some 7 bytes each.
constexpr std::size_t kPixelsTogether = std::size_t(32) << 20;

/// A view as it is uploaded.
struct ReadyView {
  MaskPyramid pyramid;
  std::vector<std::uint16_t> distances;  ///< half floats
};

/// As half floats, the nearest: drivers do not all round to these. Repeats the border beyond the
/// image: samples half a pixel outside must not meet foreign values.
std::vector<std::uint16_t> padded(const SilhouetteDistance* d, const glm::ivec2& size) {
  std::vector<std::uint16_t> out(std::size_t(size.x) * size.y,
                                 half(-SilhouetteDistance::kNoContour).bits());
  for (int y = 0; d && y < size.y; ++y) {
    const float* row = &d->pixels[std::size_t(std::min(y, d->height - 1)) * d->width];
    std::uint16_t* target = &out[std::size_t(y) * size.x];
    std::transform(row, row + d->width, target, [](float v) { return half(v).bits(); });
    std::fill(target + d->width, target + size.x, target[d->width - 1]);
  }
  return out;
}

Mask whole_image(const Intrinsics& k) {
  return {k.width, k.height, std::vector<std::uint8_t>(std::size_t(k.width) * k.height, 255)};
}

ReadyView make_ready(const Camera& camera, const Silhouette& silhouette, const glm::ivec2& size) {
  const Intrinsics& k = camera.intrinsics;
  const bool masked = silhouette.mask && !silhouette.mask->empty();
  const SilhouetteDistance* d = silhouette.distance;
  PHOTOHULL_CHECK(!d || (d->width == k.width && d->height == k.height));
  return {build_mask_pyramid(masked ? *silhouette.mask : whole_image(k), size.x, size.y),
          padded(d, size)};
}

}  // namespace

SilhouetteTextures::SilhouetteTextures(const HullViews& views)
    : cameras_(views.cameras.begin(), views.cameras.end()) {
  PHOTOHULL_CHECK(!views.cameras.empty());
  PHOTOHULL_CHECK_OP(views.cameras.size(), ==, views.silhouettes.size());
  const glm::ivec2 size = projtex::array_size(views.cameras);
  const std::size_t count = cameras_.size();
  distances_ = gpu::TextureArray(gpu::TextureFormat::kR16f, size.x, size.y, int(count));
  const std::size_t together =
      std::max<std::size_t>(1, kPixelsTogether / (std::size_t(size.x) * size.y));
  for (std::size_t first = 0; first < count; first += together) {
    std::vector<ReadyView> ready(std::min(together, count - first));
    tbb::parallel_for(std::size_t(0), ready.size(), [&](std::size_t i) {
      ready[i] = make_ready(cameras_[first + i], views.silhouettes[first + i], size);
    });
    for (std::size_t i = 0; i < ready.size(); ++i) {
      const MaskPyramid& pyramid = ready[i].pyramid;
      if (levels_ == 0) {
        levels_ = int(pyramid.levels.size());
        pyramid_ = gpu::TextureArray(gpu::TextureFormat::kRg8, pyramid.width, pyramid.height,
                                     int(count), 0);
      }
      const int layer = int(first + i);
      for (int level = 0; level < levels_; ++level)
        pyramid_.upload(layer, std::max(pyramid.width >> level, 1),
                        std::max(pyramid.height >> level, 1), pyramid.levels[level].data(), level);
      distances_.upload(layer, size.x, size.y, ready[i].distances.data());
    }
  }
}

}  // namespace photohull::carving
