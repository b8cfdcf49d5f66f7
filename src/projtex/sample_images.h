// Photographs on the device, made for one of the samplers.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/prepared_view.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "projtex/sampler.h"

namespace photohull::projtex {

/// Images as linear light times coverage, and coverage (alpha times mask), half floats, with what
/// the sampler needs beside them: mip levels (means in linear light), a ripmap or a summed-area
/// table. Images sit at the origin of layers whose sides are multiples of kPadding; there is
/// nothing elsewhere.
class SampleImages {
 public:
  /// Throws Error when the device cannot hold the images, or lacks the filter.
  SampleImages(std::span<const PreparedView> views, Sampler sampler);

  Sampler sampler() const { return sampler_; }
  int layers() const { return images_.layers(); }
  /// Pixels of a layer, for to_gpu_view.
  glm::ivec2 size() const { return {images_.width(), images_.height()}; }

  /// A compute program with this sampler, n x n times a square, and further `defines`.
  std::shared_ptr<const gpu::Program> program(gpu::Context& context, const char* path,
                                              int supersample,
                                              const std::string& defines = {}) const;
  /// Binds the textures where sample_image.glsl expects them, and sets what it asks of the images,
  /// for the dispatches of such a program that follow.
  void bind(const gpu::Program& program) const;

 private:
  Sampler sampler_;
  gpu::TextureArray images_, extra_;
  float sum_unit_ = 0;
};

}  // namespace photohull::projtex
