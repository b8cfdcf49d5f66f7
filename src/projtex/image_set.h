// The photographs on the device.
#pragma once

#include <span>
#include <vector>

#include "core/prepared_view.h"
#include "gpu/texture.h"

namespace photohull::projtex {

/// All images as layers of one array texture with mip chains, sampled to linear light. 8-bit images
/// stay 8-bit sRGB; one image of higher precision makes the whole set half float.
/// Images smaller than the array repeat their border in the unused part, so that no mip level mixes
/// anything foreign into them.
class ImageSet {
 public:
  /// `cut_at`: as array_size has it. Throws Error when the device cannot hold the images.
  explicit ImageSet(std::span<const PreparedView> views, int cut_at = 1);
  /// Room for images of up to `size` pixels, which put() fills one by one.
  ImageSet(const glm::ivec2& size, int layers, ColourImage::Encoding encoding);
  void put(int layer, const PreparedView& view);
  /// `sharpness` as sharpness() has it.
  void put(int layer, const ColourImage& image, double sharpness);
  /// Pixels of a layer's photograph, which has so many, in the encoding of the set.
  ColourImage read(int layer, const glm::ivec2& size) const;

  /// Frees the pixels of views that the device has as they are, as long as they are not needed on
  /// the host; but those with alpha, which says what a photograph shows.
  void lend(std::span<PreparedView> views) const;
  /// The same views' pixels again, byte by byte.
  void give_back(std::span<PreparedView> views) const;

  const gpu::TextureArray& texture() const { return texture_; }
  int layers() const { return texture_.layers(); }
  ColourImage::Encoding encoding() const { return encoding_; }
  /// Of every view, PreparedView::sharpness relative to 0.9, at most 1: below, it has less fine
  /// detail than views of the same without blur have, whose surface and light make some percent of
  /// difference.
  const std::vector<double>& sharpness() const { return sharpness_; }

 private:
  gpu::TextureArray room(const glm::ivec2& size, int layers) const;
  void upload(const ColourImage& image, int layer, gpu::TextureArray& to) const;

  gpu::TextureArray texture_;
  gpu::TextureArray one_;  // what put() fills before it is copied
  ColourImage::Encoding encoding_ = ColourImage::Encoding::kSrgb8;  // of the texture
  std::vector<double> sharpness_;
};

}  // namespace photohull::projtex
