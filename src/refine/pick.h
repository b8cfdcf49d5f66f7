// Packed lists; private to module refine.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/refine.h"

namespace photohull::refine {

/// The elements of `all` at `indices`.
template <typename T>
std::vector<T> pick(std::span<const T> all, std::span<const std::uint32_t> indices) {
  std::vector<T> out;
  out.reserve(indices.size());
  for (const std::uint32_t i : indices) out.push_back(all[i]);
  return out;
}

/// Surfels that enough views were chosen for to compare them.
inline std::vector<std::uint32_t> comparable(std::span<const shaders::MatchChoice> choices) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < choices.size(); ++i)
    if (choices[i].second.w >= 2) out.push_back(i);
  return out;
}

}  // namespace photohull::refine
