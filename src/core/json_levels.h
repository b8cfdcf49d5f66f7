// How deep JSON may nest.
#pragma once

#include <string>
#include <utility>

#include "core/error.h"

namespace photohull {

inline constexpr int kMostJsonLevels = 64;

/// A callback for nlohmann's parser that throws Error, naming the source, for deeper JSON. Its
/// parser takes any depth, but values are copied, compared and written by recursion, for which the
/// stack would not suffice.
inline auto json_level_guard(std::string source) {
  return [source = std::move(source)](int depth, auto, const auto&) {
    if (depth > kMostJsonLevels)
      throw Error(concat(source, ": more than ", kMostJsonLevels,
                         " levels of lists and objects; check that this is the right file"));
    return true;
  };
}

}  // namespace photohull
