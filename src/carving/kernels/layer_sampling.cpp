#include "carving/kernels/layer_sampling.h"

#include <string>

#include "carving/search_disc.h"
#include "core/error.h"
#include "projtex/device_views.h"
#include "shared/view.h"

namespace photohull::carving {
namespace {

std::string defines_of(const PhotoOptions& options, int views) {
  return search_defines(search_disc(options.search_radius)) +
         projtex::DeviceViews::defines_for(std::size_t(views));
}

}  // namespace

LayerSampling layer_sampling(gpu::Context& context, const projtex::ImageSet& images,
                             const PhotoOptions& options) {
  return {"projtex_project_layer",
          gpu::Program::compute(context, "projtex_project_layer.comp.glsl",
                                concat("#define SUPERSAMPLE ", options.supersample, "\n") +
                                    defines_of(options, images.layers())),
          [&images](const gpu::Program&) { images.texture().bind(shaders::kImagesUnit); },
          {images.texture().width(), images.texture().height()},
          false};
}

LayerSampling layer_sampling(gpu::Context& context, const projtex::SampleImages& images,
                             const PhotoOptions& options) {
  return {"projtex_sample_layer",
          images.program(context, "projtex_sample_layer.comp.glsl", options.supersample,
                         defines_of(options, images.layers())),
          [&images](const gpu::Program& program) { images.bind(program); }, images.size(), true};
}

}  // namespace photohull::carving
