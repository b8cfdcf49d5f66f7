// The look that all pages of photohull have.
#pragma once

#include <string_view>

namespace photohull::page {

/// A style sheet: colours, light and dark, and elements that more than one page has.
std::string_view base_style();

}  // namespace photohull::page
