// Two-dimensional array textures: one layer a view.
#pragma once

#include <cstddef>
#include <utility>

namespace photohull::gpu {

/// Internal formats that the program uses.
enum class TextureFormat {
  kSrgb8Alpha8,
  kRgba8,
  kRgba16f,
  kRg8,
  kR8,
  kR16f,
  kR32f,
  kRg32f,
  kR32ui,
  kRgba32ui
};

/// A move-only 2D array texture with immutable storage.
class TextureArray {
 public:
  TextureArray() = default;
  /// `levels` 0 allocates the whole mip chain. Throws Error when the device has no such textures or
  /// cannot hold it.
  TextureArray(TextureFormat format, int width, int height, int layers, int levels = 1);
  ~TextureArray();
  TextureArray(TextureArray&& other) noexcept { swap(other); }
  TextureArray& operator=(TextureArray&& other) noexcept {
    swap(other);
    return *this;
  }

  /// Writes a rectangle at the layer's origin; `pixels` are tightly packed in the natural client
  /// type of the format (bytes for 8-bit formats, halves for 16-bit ones, else floats or integers):
  /// drivers that make halves of floats do not all round to the nearest.
  void upload(int layer, int width, int height, const void* pixels, int level = 0);
  /// All levels of a layer become those of the only layer of another array of the same format and
  /// size.
  void copy_layer(const TextureArray& from, int layer);
  void read(int level, std::size_t bytes, void* pixels) const;
  /// A rectangle at the origin of a layer's level 0, in the natural client type of the format.
  void read_layer(int layer, int width, int height, std::size_t bytes, void* pixels) const;
  /// Sets every texel of level 0 of a kR32ui texture.
  void fill(unsigned word);
  /// Builds all levels below 0 by box filtering in linear light.
  void generate_mipmaps();
  /// Filtering of `bind`: trilinear between levels, or bilinear at the nearest level.
  void set_filter(bool trilinear);
  /// Beyond the border there is nothing (zeros) instead of the border's pixels.
  void set_empty_border();
  /// Lets samplers take up to so many taps along a footprint's long axis. Throws Error when the
  /// device has no anisotropic filter.
  void set_anisotropy(float most);
  void bind(unsigned unit) const;
  void bind_image(unsigned unit, int level, bool write) const;
  /// For kernels that both read and write level 0.
  void bind_read_write(unsigned unit) const;

  unsigned id() const { return id_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int layers() const { return layers_; }
  int levels() const { return levels_; }

 private:
  void swap(TextureArray& other) noexcept;
  unsigned id_ = 0;
  TextureFormat format_ = TextureFormat::kRgba8;
  int width_ = 0, height_ = 0, layers_ = 0, levels_ = 0;
};

}  // namespace photohull::gpu
