// Random numbers that depend on their place only: the same for every order and number of threads.
// Internal to synth.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace photohull::synth {

/// Mixes 64 bits [Steele14].
inline std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// A stream of its own for every seed and place; successive draws count on.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t a = 0, std::uint64_t b = 0)
      : key_(mix_bits(mix_bits(mix_bits(seed) ^ a) + b)) {}

  std::uint64_t bits() { return mix_bits(key_ + 0x632be59bd9b4e019ull * ++count_); }
  /// In [0, 1).
  double uniform() { return double(bits() >> 11) * 0x1p-53; }
  /// Standard normal (Box and Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2 * std::log1p(-uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace photohull::synth
