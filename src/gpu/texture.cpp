#include "gpu/texture.h"

#include <algorithm>
#include <bit>
#include <string_view>

#include "core/error.h"
#include "core/option_word.h"
#include "gpu/gl.h"
#include "gpu/gl_error.h"
#include "gpu/limits.h"
#include "gpu/traffic.h"

namespace photohull::gpu {
namespace {

struct FormatInfo {
  GLenum internal, layout, type;
  std::size_t bytes;  ///< of a texel, in the client's memory
};

FormatInfo info_of(TextureFormat format) {
  switch (format) {
    case TextureFormat::kSrgb8Alpha8:
      return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case TextureFormat::kRgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case TextureFormat::kRgba16f:
      return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8};
    case TextureFormat::kRg8:
      return {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, 2};
    case TextureFormat::kR8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1};
    case TextureFormat::kR16f:
      return {GL_R16F, GL_RED, GL_HALF_FLOAT, 2};
    case TextureFormat::kR32f:
      return {GL_R32F, GL_RED, GL_FLOAT, 4};
    case TextureFormat::kRg32f:
      return {GL_RG32F, GL_RG, GL_FLOAT, 8};
    case TextureFormat::kR32ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
    case TextureFormat::kRgba32ui:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16};
  }
  check_failed(__FILE__, __LINE__, "texture format");
}

void check_size(int width, int height, int layers) {
  const Limits& limits = current_limits();
  if (std::max(width, height) > limits.texture_size)
    throw Error(concat("this graphics device has no images of ", width, "x", height,
                       " pixels, only up to ", limits.texture_size,
                       " a side; read the photographs smaller (", option_word("image_scale"),
                       "), or give another ", option_word("device")));
  if (layers > limits.texture_layers)
    throw Error(concat("this graphics device takes ", limits.texture_layers,
                       " images at once, and ", layers, " were given; use fewer views (",
                       option_word("views"), "), or give another ", option_word("device")));
}

}  // namespace

TextureArray::TextureArray(TextureFormat format, int width, int height, int layers, int levels)
    : format_(format), width_(width), height_(height), layers_(layers) {
  check_size(width, height, layers);
  const int full = int(std::bit_width(unsigned(std::max(width, height))));
  levels_ = levels == 0 ? full : std::min(levels, full);
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id_);
  glTextureStorage3D(id_, levels_, info_of(format).internal, width, height, layers);
  const unsigned error = pending_error();
  if (error != GL_NO_ERROR) {
    glDeleteTextures(1, &id_);
    throw_gl_error(error, concat(layers, " images of ", width, "x", height),
                   concat("use fewer views (", option_word("views"), ") or smaller images"));
  }
  glTextureParameteri(id_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  // Integers cannot be filtered.
  const bool integers = format == TextureFormat::kRgba32ui || format == TextureFormat::kR32ui;
  glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, integers ? GL_NEAREST : GL_LINEAR);
  if (integers)
    glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  else
    set_filter(false);
}

TextureArray::~TextureArray() {
  if (id_) glDeleteTextures(1, &id_);
}

void TextureArray::swap(TextureArray& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(format_, other.format_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  std::swap(layers_, other.layers_);
  std::swap(levels_, other.levels_);
}

void TextureArray::upload(int layer, int width, int height, const void* pixels, int level) {
  const FormatInfo f = info_of(format_);
  glTextureSubImage3D(id_, level, 0, 0, layer, width, height, 1, f.layout, f.type, pixels);
  count_upload(std::size_t(width) * std::size_t(height) * f.bytes);
}

void TextureArray::copy_layer(const TextureArray& from, int layer) {
  PHOTOHULL_CHECK(from.format_ == format_ && from.layers_ == 1 && from.levels_ == levels_);
  PHOTOHULL_CHECK(from.width_ == width_ && from.height_ == height_);
  for (int level = 0; level < levels_; ++level)
    glCopyImageSubData(from.id_, GL_TEXTURE_2D_ARRAY, level, 0, 0, 0, id_, GL_TEXTURE_2D_ARRAY,
                       level, 0, 0, layer, std::max(width_ >> level, 1),
                       std::max(height_ >> level, 1), 1);
  check_gl("copying a texture");
}

void TextureArray::read(int level, std::size_t bytes, void* pixels) const {
  const FormatInfo f = info_of(format_);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(id_, level, f.layout, f.type, GLsizei(bytes), pixels);
  count_download(bytes);
  check_gl("reading a texture");
}

void TextureArray::read_layer(int layer, int width, int height, std::size_t bytes,
                              void* pixels) const {
  const FormatInfo f = info_of(format_);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureSubImage(id_, 0, 0, 0, layer, width, height, 1, f.layout, f.type, GLsizei(bytes),
                       pixels);
  count_download(bytes);
  check_gl("reading a texture");
}

void TextureArray::fill(unsigned word) {
  glClearTexImage(id_, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void TextureArray::generate_mipmaps() { glGenerateTextureMipmap(id_); }

void TextureArray::set_filter(bool trilinear) {
  const GLenum mip = trilinear ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST;
  glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GLint(levels_ > 1 ? mip : GL_LINEAR));
}

void TextureArray::set_empty_border() {
  glTextureParameteri(id_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(id_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
}

void TextureArray::set_anisotropy(float most) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  bool offered = false;
  for (GLint i = 0; i < count; ++i)
    offered = offered || std::string_view(
                             reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i))))
                             .ends_with("_texture_filter_anisotropic");
  if (!offered)
    throw Error(concat("this device has no anisotropic texture filter of its own; use ",
                       option_word("sampler", "anisotropic")));
  GLfloat limit = 1;
  glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &limit);
  glTextureParameterf(id_, GL_TEXTURE_MAX_ANISOTROPY, std::min(most, limit));
}

void TextureArray::bind(unsigned unit) const { glBindTextureUnit(unit, id_); }

void TextureArray::bind_image(unsigned unit, int level, bool write) const {
  glBindImageTexture(unit, id_, level, GL_TRUE, 0, write ? GL_WRITE_ONLY : GL_READ_ONLY,
                     info_of(format_).internal);
}

void TextureArray::bind_read_write(unsigned unit) const {
  glBindImageTexture(unit, id_, 0, GL_TRUE, 0, GL_READ_WRITE, info_of(format_).internal);
}

}  // namespace photohull::gpu
