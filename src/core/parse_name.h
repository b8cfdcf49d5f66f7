// Values of an enumeration by the names that its to_string gives.
#pragma once

#include <string>

#include "core/error.h"

namespace photohull {

/// The one of `values` that is called `text`. Throws UsageError, which names the option and lists
/// the legal names, where there is none.
template <typename Values>
auto parse_name(const std::string& option, const std::string& text, const Values& values) {
  std::string legal;
  for (const auto& value : values) {
    if (text == to_string(value)) return value;
    legal += (legal.empty() ? "" : ", ") + std::string(to_string(value));
  }
  throw UsageError(concat(option, " ", text, ": expected one of ", legal));
}

}  // namespace photohull
