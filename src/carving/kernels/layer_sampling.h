// How photographs come onto the layers of a sweep (projtex_project_layer.comp.glsl,
// projtex_sample_layer.comp.glsl).
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>

#include "carving/photo.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "projtex/image_set.h"
#include "projtex/sample_images.h"

namespace photohull::carving {

struct LayerSampling {
  const char* launch;  ///< name of the dispatches
  std::shared_ptr<const gpu::Program> program;
  std::function<void(const gpu::Program&)> bind;  ///< binds the images, which outlive the object
  glm::ivec2 size;                                ///< pixels of the array texture
  bool coverage;  ///< alpha tells how much of a sample is the object's
};

/// One mip level for each brick.
LayerSampling layer_sampling(gpu::Context& context, const projtex::ImageSet& images,
                             const PhotoOptions& options);
/// With the sampler that the images were made for.
LayerSampling layer_sampling(gpu::Context& context, const projtex::SampleImages& images,
                             const PhotoOptions& options);

}  // namespace photohull::carving
