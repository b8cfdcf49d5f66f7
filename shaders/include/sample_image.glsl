// One interface to all samplers: `sample_image` of the one that SAMPLER_... chooses, and n x n of its
// footprints over a square (supersampling [Montenegro03, 3.4.2]). Values are linear light times
// coverage, and coverage: what is outside the image, behind the camera or off the object adds nothing.
#include "include/footprint.glsl"
#include "include/covered_image.glsl"
#include "shared/sampling.h"

#ifndef SUPERSAMPLE
#define SUPERSAMPLE 1
#endif

#if defined(SAMPLER_CENTROID) || defined(SAMPLER_NEAREST)
#include "include/sample_nearest.glsl"
#elif defined(SAMPLER_BILINEAR)
#include "include/sample_bilinear.glsl"
#elif defined(SAMPLER_MIPMAP)
#include "include/sample_mipmap.glsl"
#elif defined(SAMPLER_RIPMAP)
#include "include/sample_ripmap.glsl"
#elif defined(SAMPLER_SUMMED_AREA)
#include "include/sample_summed_area.glsl"
#elif defined(SAMPLER_ANISOTROPIC)
#include "include/sample_anisotropic.glsl"
#elif defined(SAMPLER_HARDWARE)
#include "include/sample_hardware.glsl"
#elif defined(SAMPLER_EWA)
#include "include/sample_ewa.glsl"
#else
#ifdef SAMPLER_TRILINEAR_DERIVATIVE
#define LAMBDA_OF_DERIVATIVE
#endif
#include "include/sample_trilinear.glsl"
#endif

// The square with homogeneous coordinates `at` in the middle and edges `by_u`, `by_v`.
vec4 sample_square(GpuView view, uint v, vec3 at, vec3 by_u, vec3 by_v) {
  const int n = SUPERSAMPLE;
  const float part = 1.0 / float(n);
  vec4 sum = vec4(0.0);
  for (int k = 0; k < n * n; ++k) {
    vec2 offset = (vec2(float(k % n), float(k / n)) + 0.5) * part - 0.5;
    vec3 p = at + by_u * offset.x + by_v * offset.y;
    if (p.z > 0.0) sum += sample_image(footprint_of(view, v, p, by_u * part, by_v * part));
  }
  return sum * (part * part);
}

// Square roots of the linear colour without its coverage, which makes the noise even, and the coverage.
vec4 resolve(vec4 covered) {
  return covered.a > 0.0 ? vec4(sqrt(max(covered.rgb * (1.0 / covered.a), 0.0)), covered.a) : vec4(0.0);
}
