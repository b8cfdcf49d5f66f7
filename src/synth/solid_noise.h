// Gradient noise on 3-space (Perlin, "Improving noise", 2002). Internal to synth.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace photohull::synth {

/// The largest integer not above x; the library's floor is a call where the instruction is missing.
inline std::int32_t whole(float x) {
  const auto i = std::int32_t(x);
  return i - (float(i) > x);
}

/// Smooth noise of period-free lattice cells of size 1, in about [-1, 1], 0 on average.
inline float gradient_noise(const glm::vec3& p, std::uint32_t seed) {
  const std::int32_t i = whole(p.x), j = whole(p.y), k = whole(p.z);
  const glm::vec3 f = p - glm::vec3(float(i), float(j), float(k));
  const auto x = std::uint32_t(i), y = std::uint32_t(j), z = std::uint32_t(k);
  const auto corner = [&](std::uint32_t dx, std::uint32_t dy, std::uint32_t dz) {
    std::uint32_t h =
        (x + dx) * 0x8da6b343u ^ (y + dy) * 0xd8163841u ^ (z + dz) * 0xcb1ab31fu ^ seed;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h ^= h >> 13;
    // One of the twelve directions to a cube's edges.
    const float a = f.x - float(dx), b = f.y - float(dy), c = f.z - float(dz);
    const std::uint32_t pick = ((h >> 16) * 12) >> 16;
    const float u = pick < 8 ? a : b;
    const float v = pick < 4 ? b : c;
    return (h & 1 ? u : -u) + (h & 2 ? v : -v);
  };
  const glm::vec3 w = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
  const auto row = [&](std::uint32_t dy, std::uint32_t dz) {
    const float a = corner(0, dy, dz);
    return a + w.x * (corner(1, dy, dz) - a);
  };
  const auto plane = [&](std::uint32_t dz) {
    const float a = row(0, dz);
    return a + w.y * (row(1, dz) - a);
  };
  const float a = plane(0);
  return a + w.z * (plane(1) - a);
}

/// Octaves of it, each twice as fine as the one before and `gain` times as strong, divided by the
/// root of the sum of squares, so that the deviation does not depend on the number of octaves.
inline float octave_noise(const glm::vec3& p, int octaves, float gain, std::uint32_t seed) {
  float sum = 0, weight = 1, power = 0;
  glm::vec3 q = p;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * gradient_noise(q, seed + std::uint32_t(i) * 0x9e3779b9u);
    power += weight * weight;
    weight *= gain;
    q = 2.0f * q + glm::vec3(0.37f, 0.71f, 0.53f);
  }
  return sum / std::sqrt(power);
}

}  // namespace photohull::synth
