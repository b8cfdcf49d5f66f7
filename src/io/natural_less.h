// The order in which people count files.
#pragma once

#include <string_view>

namespace photohull::io {

/// Digits compare as numbers: "view2" before "view10". A strict order: only equal names are equal.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace photohull::io
