// The ways to resample a photograph on a plane [Montenegro03, 3.4.2].
#pragma once

#include <span>
#include <string>

namespace photohull::projtex {

enum class Sampler {
  kMipmap,               ///< bilinear at the nearest mip level; on an ImageSet, one level a brick
  kCentroid,             ///< the voxel's centre to the nearest pixel: carving in image space
  kNearest,              ///< nearest pixel
  kBilinear,             ///< bilinear on the image itself
  kTrilinear,            ///< mip levels by the footprint's longest edge [Williams83]
  kTrilinearDerivative,  ///< mip levels by the largest derivative
  kRipmap,               ///< levels of their own along x and y
  kSummedArea,           ///< exact integral over an upright rectangle [Crow84]
  kAnisotropic,          ///< level by the short axis, up to 16 taps along the long one
  kHardware,             ///< the device's own anisotropic filter
  kEwa                   ///< elliptical Gaussian [Heckbert89]
};

inline constexpr Sampler kSamplers[] = {
    Sampler::kMipmap,   Sampler::kCentroid,   Sampler::kNearest,
    Sampler::kBilinear, Sampler::kTrilinear,  Sampler::kTrilinearDerivative,
    Sampler::kRipmap,   Sampler::kSummedArea, Sampler::kAnisotropic,
    Sampler::kHardware, Sampler::kEwa};

/// Mip levels of images made for sampling, and what their sides are multiples of, so that every
/// level halves the one before exactly.
inline constexpr int kSampleLevels = 7;
inline constexpr int kPadding = 1 << (kSampleLevels - 1);

inline constexpr int kMaxSupersample = 8;

/// What the sweep uses unless told otherwise; docs/measurements/sampling.md says why.
inline constexpr Sampler kDefaultSampler = Sampler::kAnisotropic;

/// Name on the command line: "mipmap", "centroid", ...
const char* to_string(Sampler sampler);

/// Lines of "#define" that make the kernels use the sampler.
std::string sampler_defines(Sampler sampler, int supersample);

}  // namespace photohull::projtex
