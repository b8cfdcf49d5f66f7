#include "projtex/sample_images.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <utility>
#include <vector>

#include "core/error.h"
#include "projtex/gpu_views.h"
#include "shared/sampling.h"

namespace photohull::projtex {
namespace {

constexpr float kMostAnisotropy = 16;
constexpr double kFullSum = 65535;  // of a pixel in a summed-area table

struct Level {
  int width = 0, height = 0;
  std::vector<glm::vec4> pixels;

  Level(int w, int h)
      : width(w), height(h), pixels(std::size_t(w) * std::size_t(h), glm::vec4(0)) {}
  glm::vec4& at(int x, int y) {
    return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
  const glm::vec4& at(int x, int y) const {
    return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

glm::ivec2 padded_size(std::span<const PreparedView> views) {
  const glm::ivec2 size = array_size(cameras_of(views));
  return (size + kPadding - 1) / kPadding * kPadding;
}

Level covered(const PreparedView& view, const glm::ivec2& size) {
  const ColourImage& image = view.image;
  PHOTOHULL_CHECK(image.width == view.camera.intrinsics.width);
  PHOTOHULL_CHECK(image.height == view.camera.intrinsics.height);
  PHOTOHULL_CHECK(view.mask.empty() ||
                  (view.mask.width == image.width && view.mask.height == image.height));
  Level out(size.x, size.y);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::vec4 colour = image.linear(x, y);
      const std::size_t index = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
      const float object = view.mask.empty() ? 1.0f : float(view.mask.coverage[index]) / 255.0f;
      const float coverage = colour.a * object;
      out.at(x, y) = glm::vec4(glm::vec3(colour) * coverage, coverage);
    }
  return out;
}

/// Means of `step` pixels, 2 along one axis or both.
Level halved(const Level& fine, const glm::ivec2& step) {
  Level out(fine.width / step.x, fine.height / step.y);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      glm::vec4 sum(0);
      for (int b = 0; b < step.y; ++b)
        for (int a = 0; a < step.x; ++a) sum += fine.at(x * step.x + a, y * step.y + b);
      out.at(x, y) = sum / float(step.x * step.y);
    }
  return out;
}

void upload(gpu::TextureArray& texture, int layer, int level, const Level& image) {
  std::vector<glm::uint64> packed(image.pixels.size());
  std::transform(image.pixels.begin(), image.pixels.end(), packed.begin(),
                 [](const glm::vec4& p) { return glm::packHalf4x16(p); });
  texture.upload(layer, image.width, image.height, packed.data(), level);
}

/// All levels (i, j) side by side in twice the size (sample_ripmap.glsl).
Level ripmap(const Level& image) {
  Level atlas(2 * image.width, 2 * image.height);
  Level row = image;
  for (int j = 0; j < kSampleLevels; ++j) {
    Level level = row;
    for (int i = 0; i < kSampleLevels; ++i) {
      const int left = 2 * (image.width - level.width), top = 2 * (image.height - level.height);
      for (int y = 0; y < level.height; ++y)
        std::copy_n(&level.at(0, y), level.width, &atlas.at(left, top + y));
      if (i + 1 < kSampleLevels) level = halved(level, {2, 1});
    }
    if (j + 1 < kSampleLevels) row = halved(row, {1, 2});
  }
  return atlas;
}

/// Sums of the pixels above and to the left, modulo 2^32, colours in units of `unit`.
std::vector<glm::uvec4> sums_of(const Level& image, float unit) {
  const std::size_t stride = std::size_t(image.width) + 1;
  std::vector<glm::uvec4> sums(stride * (std::size_t(image.height) + 1), glm::uvec4(0));
  const glm::vec4 scale(glm::vec3(1 / unit), float(kFullSum));
  for (int y = 0; y < image.height; ++y) {
    glm::uvec4 row(0);
    for (int x = 0; x < image.width; ++x) {
      row += glm::uvec4(glm::round(image.at(x, y) * scale));
      const std::size_t below = (std::size_t(y) + 1) * stride + std::size_t(x) + 1;
      sums[below] = sums[below - stride] + row;
    }
  }
  return sums;
}

bool has_levels(Sampler sampler) {
  return sampler == Sampler::kMipmap || sampler == Sampler::kTrilinear ||
         sampler == Sampler::kTrilinearDerivative || sampler == Sampler::kAnisotropic ||
         sampler == Sampler::kHardware || sampler == Sampler::kEwa;
}

}  // namespace

SampleImages::SampleImages(std::span<const PreparedView> views, Sampler sampler)
    : sampler_(sampler) {
  PHOTOHULL_CHECK(!views.empty());
  const glm::ivec2 size = padded_size(views);
  const int count = int(views.size()), levels = has_levels(sampler) ? kSampleLevels : 1;
  images_ = gpu::TextureArray(gpu::TextureFormat::kRgba16f, size.x, size.y, count, levels);
  images_.set_empty_border();
  if (levels > 1) images_.set_filter(true);
  if (sampler == Sampler::kHardware) images_.set_anisotropy(kMostAnisotropy);
  if (sampler == Sampler::kRipmap)
    extra_ = gpu::TextureArray(gpu::TextureFormat::kRgba16f, 2 * size.x, 2 * size.y, count);
  if (sampler == Sampler::kSummedArea) {
    extra_ = gpu::TextureArray(gpu::TextureFormat::kRgba32ui, size.x + 1, size.y + 1, count);
    float most = 1;
    for (const PreparedView& view : views)
      for (const glm::vec4& p : covered(view, size).pixels) most = std::max({most, p.r, p.g, p.b});
    sum_unit_ = most / float(kFullSum);
  }
  for (int i = 0; i < count; ++i) {
    Level level = covered(views[std::size_t(i)], size);
    upload(images_, i, 0, level);
    if (sampler == Sampler::kRipmap) {
      const Level atlas = ripmap(level);
      upload(extra_, i, 0, atlas);
    }
    if (sampler == Sampler::kSummedArea)
      extra_.upload(i, size.x + 1, size.y + 1, sums_of(level, sum_unit_).data());
    for (int l = 1; l < levels; ++l) {
      level = halved(level, {2, 2});
      upload(images_, i, l, level);
    }
  }
}

std::shared_ptr<const gpu::Program> SampleImages::program(gpu::Context& context, const char* path,
                                                          int supersample,
                                                          const std::string& defines) const {
  return gpu::Program::compute(context, path, sampler_defines(sampler_, supersample) + defines);
}

void SampleImages::bind(const gpu::Program& program) const {
  images_.bind(shaders::kImagesUnit);
  static_assert(shaders::kImageSumsUnit == shaders::kImageRipmapsUnit);
  if (extra_.id()) extra_.bind(shaders::kImageSumsUnit);
  if (sampler_ == Sampler::kSummedArea) program.set("sum_unit", sum_unit_);
}

}  // namespace photohull::projtex
