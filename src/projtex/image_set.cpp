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

/// The pixels, as many as the camera has.
const ColourImage& image_of(const PreparedView& view) {
  PHOTOHULL_CHECK(view.image.width == view.camera.intrinsics.width);
  PHOTOHULL_CHECK(view.image.height == view.camera.intrinsics.height);
  return view.image;
}

double usable_sharpness(const PreparedView& view) {
  return std::min(view.sharpness / kUnblurred, 1.0);
}

Encoding encoding_of(std::span<const PreparedView> views) {
  const bool half = std::ranges::any_of(
      views, [](const PreparedView& v) { return v.image.encoding == Encoding::kLinearHalf; });
  return half ? Encoding::kLinearHalf : Encoding::kSrgb8;
}

}  // namespace

ImageSet::ImageSet(std::span<const PreparedView> views, int cut_at)
    : ImageSet(array_size(cameras_of(views), cut_at), int(views.size()), encoding_of(views)) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    upload(image_of(views[i]), int(i), texture_);
    sharpness_[i] = usable_sharpness(views[i]);
  }
  texture_.generate_mipmaps();
}

ImageSet::ImageSet(const glm::ivec2& size, int layers, ColourImage::Encoding encoding)
    : encoding_(encoding), sharpness_(std::size_t(layers), 1) {
  PHOTOHULL_CHECK(layers > 0);
  texture_ = room(size, layers);
}

void ImageSet::put(int layer, const PreparedView& view) {
  put(layer, image_of(view), usable_sharpness(view));
}

void ImageSet::put(int layer, const ColourImage& image, double sharpness) {
  // On its own: the mip levels of all the others would be made as well.
  if (one_.layers() == 0) one_ = room({texture_.width(), texture_.height()}, 1);
  upload(image, 0, one_);
  one_.generate_mipmaps();
  texture_.copy_layer(one_, layer);
  sharpness_[std::size_t(layer)] = sharpness;
}

gpu::TextureArray ImageSet::room(const glm::ivec2& size, int layers) const {
  return {encoding_ == Encoding::kLinearHalf ? gpu::TextureFormat::kRgba16f
                                             : gpu::TextureFormat::kSrgb8Alpha8,
          size.x, size.y, layers, 0};
}

void ImageSet::upload(const ColourImage& image, int layer, gpu::TextureArray& to) const {
  const glm::ivec2 size(to.width(), to.height());
  const bool half = encoding_ == Encoding::kLinearHalf;
  std::vector<std::uint8_t> converted, padded;
  const std::uint8_t* pixels = image.bytes.data();
  if (half && image.encoding == Encoding::kSrgb8) {
    converted = to_half(image);
    pixels = converted.data();
  }
  if (image.width != size.x || image.height != size.y) {
    padded = pad(pixels, image, size, half ? 8 : 4);
    pixels = padded.data();
  }
  to.upload(layer, size.x, size.y, pixels);
}

ColourImage ImageSet::read(int layer, const glm::ivec2& size) const {
  ColourImage out{size.x, size.y, encoding_, false, {}};
  out.bytes.resize(std::size_t(size.x) * std::size_t(size.y) * out.bytes_per_pixel());
  texture_.read_layer(layer, size.x, size.y, out.bytes.size(), out.bytes.data());
  return out;
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
    if (image.bytes.empty()) image.bytes = read(int(i), {image.width, image.height}).bytes;
  }
}

}  // namespace photohull::projtex
