// Gradient noise on 3-space [Perlin02]. Internal to synth.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photohull::synth {

/// The largest integer not above x; the library's floor is a call where the instruction is missing.
[[gnu::always_inline]] inline std::int32_t whole(float x) {
  const auto i = std::int32_t(x);
  return i - (float(i) > x);
}

/// Smooth noise on a lattice of cells of size 1, in about [-1, 1], 0 on average. Free of branches,
/// so that a loop over points becomes vector code.
[[gnu::always_inline]] inline float gradient_noise(float px, float py, float pz,
                                                   std::uint32_t seed) {
  const std::int32_t i = whole(px), j = whole(py), k = whole(pz);
  const float fx = px - float(i), fy = py - float(j), fz = pz - float(k);
  const auto corner = [&](int dx, int dy, int dz) __attribute__((always_inline)) {
    std::uint32_t h = std::uint32_t(i + dx) * 0x8da6b343u ^ std::uint32_t(j + dy) * 0xd8163841u ^
                      std::uint32_t(k + dz) * 0xcb1ab31fu ^ seed;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h ^= h >> 13;
    // One of the twelve directions to a cube's edges.
    const float a = fx - float(dx), b = fy - float(dy), c = fz - float(dz);
    const auto pick = std::int32_t(((h >> 16) * 12) >> 16);
    const float u = pick < 8 ? a : b;
    const float v = pick < 4 ? b : c;
    const float su = 1.0f - 2.0f * float(std::int32_t(h & 1));
    const float sv = 1.0f - float(std::int32_t(h & 2));
    return su * u + sv * v;
  };
  const auto fade = [](float f) __attribute__((always_inline)) {
    return f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
  };
  const float wx = fade(fx), wy = fade(fy), wz = fade(fz);
  const auto row = [&](int dy, int dz) __attribute__((always_inline)) {
    const float a = corner(0, dy, dz);
    return a + wx * (corner(1, dy, dz) - a);
  };
  const auto plane = [&](int dz) __attribute__((always_inline)) {
    const float a = row(0, dz);
    return a + wy * (row(1, dz) - a);
  };
  const float a = plane(0);
  return a + wz * (plane(1) - a);
}

/// Many points, one array a coordinate.
struct NoisePoints {
  std::vector<float> x, y, z;

  void resize(std::size_t count) { x.resize(count), y.resize(count), z.resize(count); }
  void set(std::size_t i, const glm::vec3& p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
};

/// sum[i] += weight * noise of (scale * point i + shift).
void add_noise(const NoisePoints& points, float scale, const glm::vec3& shift, float weight,
               std::uint32_t seed, std::span<float> sum);

/// Octaves of it, each twice as fine as the one before and `gain` times as strong, divided by the
/// root of the sum of squares, so that the deviation does not depend on the number of octaves.
/// Sets sum[i] for every point.
void octave_noise(const NoisePoints& points, float scale, int octaves, float gain,
                  std::uint32_t seed, std::span<float> sum);

}  // namespace photohull::synth
