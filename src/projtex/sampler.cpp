#include "projtex/sampler.h"

#include "core/error.h"

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

Sampler parse_sampler(const std::string& option, const std::string& text) {
  std::string legal;
  for (const Sampler sampler : kSamplers) {
    if (text == to_string(sampler)) return sampler;
    legal += (legal.empty() ? "" : ", ") + std::string(to_string(sampler));
  }
  throw UsageError(concat(option, " ", text, ": expected one of ", legal));
}

std::string sampler_defines(Sampler sampler, int supersample) {
  PHOTOHULL_CHECK(supersample >= 1 && supersample <= kMaxSupersample);
  std::string name = to_string(sampler);
  for (char& c : name) c = c == '-' ? '_' : char(c - 'a' + 'A');
  return concat("#define SAMPLER_", name, "\n#define SUPERSAMPLE ", supersample, "\n");
}

}  // namespace photohull::projtex
