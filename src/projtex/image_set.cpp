#include "projtex/image_set.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "core/error.h"
#include "projtex/gpu_views.h"

namespace photohull::projtex {
namespace {

constexpr double kUnblurred = 0.9;  // least sharpness of most views without blur, beside others

using Encoding = ColourImage::Encoding;

std::vector<std::uint8_t> to_half(const ColourImage& image) {
  std::vector<std::uint8_t> out(std::size_t(image.width) * image.height * 8);
  std::uint8_t* target = out.data();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, target += 8) {
      const glm::uint64 packed = glm::packHalf4x16(image.linear(x, y));
      std::memcpy(target, &packed, 8);
    }
  return out;
}

std::vector<std::uint8_t> pad(const std::uint8_t* pixels, const ColourImage& image,
                              const glm::ivec2& size, std::size_t pixel_bytes) {
  std::vector<std::uint8_t> out(std::size_t(size.x) * size.y * pixel_bytes);
  for (int y = 0; y < size.y; ++y) {
    const std::uint8_t* row =
        pixels + std::size_t(std::min(y, image.height - 1)) * image.width * pixel_bytes;
    for (int x = 0; x < size.x; ++x)
      std::memcpy(&out[(std::size_t(y) * size.x + x) * pixel_bytes],
                  row + std::size_t(std::min(x, image.width - 1)) * pixel_bytes, pixel_bytes);
  }
  return out;
}

}  // namespace

ImageSet::ImageSet(std::span<const PreparedView> views) {
  PHOTOHULL_CHECK(!views.empty());
  const std::vector<Camera> cameras = cameras_of(views);
  const glm::ivec2 size = array_size(cameras);
  const bool half = std::any_of(views.begin(), views.end(), [](const PreparedView& v) {
    return v.image.encoding == Encoding::kLinearHalf;
  });
  encoding_ = half ? Encoding::kLinearHalf : Encoding::kSrgb8;
  texture_ =
      gpu::TextureArray(half ? gpu::TextureFormat::kRgba16f : gpu::TextureFormat::kSrgb8Alpha8,
                        size.x, size.y, int(views.size()), 0);
  const std::size_t pixel_bytes = half ? 8 : 4;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ColourImage& image = views[i].image;
    PHOTOHULL_CHECK(image.width == views[i].camera.intrinsics.width);
    PHOTOHULL_CHECK(image.height == views[i].camera.intrinsics.height);
    std::vector<std::uint8_t> converted, padded;
    const std::uint8_t* pixels = image.bytes.data();
    if (half && image.encoding == Encoding::kSrgb8) {
      converted = to_half(image);
      pixels = converted.data();
    }
    if (image.width != size.x || image.height != size.y) {
      padded = pad(pixels, image, size, pixel_bytes);
      pixels = padded.data();
    }
    texture_.upload(int(i), size.x, size.y, pixels);
  }
  texture_.generate_mipmaps();
  for (const PreparedView& view : views)
    sharpness_.push_back(std::min(view.sharpness / kUnblurred, 1.0));
}

void ImageSet::lend(std::span<PreparedView> views) const {
  for (PreparedView& view : views)
    if (!view.image.has_alpha && view.image.encoding == encoding_)
      std::vector<std::uint8_t>().swap(view.image.bytes);
}

void ImageSet::give_back(std::span<PreparedView> views) const {
  PHOTOHULL_CHECK_OP(int(views.size()), ==, layers());
  for (std::size_t i = 0; i < views.size(); ++i) {
    ColourImage& image = views[i].image;
    if (!image.bytes.empty()) continue;
    image.bytes.resize(std::size_t(image.width) * std::size_t(image.height) *
                       image.bytes_per_pixel());
    texture_.read_layer(int(i), image.width, image.height, image.bytes.size(), image.bytes.data());
  }
}

}  // namespace photohull::projtex
