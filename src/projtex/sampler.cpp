#include "projtex/sampler.h"

#include "core/error.h"
#include "gpu/shader_source.h"

namespace photohull::projtex {

const char* to_string(Sampler sampler) {
  switch (sampler) {
    case Sampler::kMipmap:
      return "mipmap";
    case Sampler::kCentroid:
      return "centroid";
    case Sampler::kNearest:
      return "nearest";
    case Sampler::kBilinear:
      return "bilinear";
    case Sampler::kTrilinear:
      return "trilinear";
    case Sampler::kTrilinearDerivative:
      return "trilinear-derivative";
    case Sampler::kRipmap:
      return "ripmap";
    case Sampler::kSummedArea:
      return "summed-area";
    case Sampler::kAnisotropic:
      return "anisotropic";
    case Sampler::kHardware:
      return "hardware";
    case Sampler::kEwa:
      return "ewa";
  }
  return "?";
}

std::string sampler_defines(Sampler sampler, int supersample) {
  PHOTOHULL_CHECK(supersample >= 1 && supersample <= kMaxSupersample);
  return gpu::define("SAMPLER_", to_string(sampler)) +
         gpu::define("SUPERSAMPLE ", concat(supersample));
}

}  // namespace photohull::projtex
