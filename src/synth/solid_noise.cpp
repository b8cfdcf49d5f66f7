#include "synth/solid_noise.h"

#include <algorithm>

namespace photohull::synth {

// Two versions, chosen when the program starts, which is too early for sanitizers. Neither fuses
// multiplications with additions, so both give the same values.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define PHOTOHULL_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define PHOTOHULL_WIDE
#endif

PHOTOHULL_WIDE void add_noise_to(const float* x, const float* y, const float* z, std::size_t count,
                                 float scale, float sx, float sy, float sz, float weight,
                                 std::uint32_t seed, float* sum) {
  for (std::size_t i = 0; i < count; ++i)
    sum[i] +=
        weight * gradient_noise(scale * x[i] + sx, scale * y[i] + sy, scale * z[i] + sz, seed);
}

void add_noise(const NoisePoints& points, float scale, const glm::vec3& shift, float weight,
               std::uint32_t seed, std::span<float> sum) {
  add_noise_to(points.x.data(), points.y.data(), points.z.data(), sum.size(), scale, shift.x,
               shift.y, shift.z, weight, seed, sum.data());
}

void octave_noise(const NoisePoints& points, float scale, int octaves, float gain,
                  std::uint32_t seed, std::span<float> sum) {
  std::fill(sum.begin(), sum.end(), 0.0f);
  float power = 0;
  for (int i = 0; i < octaves; ++i) power += std::pow(gain, 2.0f * float(i));
  float weight = 1 / std::sqrt(power);
  glm::vec3 shift(0);
  for (int i = 0; i < octaves; ++i) {
    add_noise(points, scale, shift, weight, seed + std::uint32_t(i) * 0x9e3779b9u, sum);
    weight *= gain;
    scale *= 2;
    shift = 2.0f * shift + glm::vec3(0.37f, 0.71f, 0.53f);
  }
}

}  // namespace photohull::synth
