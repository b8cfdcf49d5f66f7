// Half floats (IEEE 754 binary16).
#pragma once

#include <bit>
#include <cstdint>

namespace photohull {

/// The half float nearest to a number, of two that are equally near the one whose last bit is 0;
/// infinite from 65520 on. Not for NaN. (GLM rounds ties away from zero, and drivers differ.)
inline std::uint16_t half_float(float value) {
  constexpr std::uint32_t kLeastNormal = 0x38800000;  // 2^-14
  constexpr std::uint32_t kTooLarge = 0x47800000;     // 65536
  constexpr std::uint32_t kBias = 112u << 23;  // exponents count from 127, those of halves from 15
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000u;
  std::uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude >= kTooLarge) return std::uint16_t(sign | 0x7c00u);
  if (magnitude < kLeastNormal) {
    // Steps of 2^-24, to which the sum with 1/2 is rounded.
    const float sum = std::bit_cast<float>(magnitude) + 0.5f;
    return std::uint16_t(sign | (std::bit_cast<std::uint32_t>(sum) & 0x7fffu));
  }
  magnitude -= kBias;
  magnitude += 0x0fffu + (magnitude >> 13 & 1u);  // 13 bits go; a carry goes into the exponent
  return std::uint16_t(sign | magnitude >> 13);
}

}  // namespace photohull
