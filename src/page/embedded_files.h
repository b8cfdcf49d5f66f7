// Text files that are part of the program. Private to page.
#pragma once

#include <string_view>

namespace photohull::page {

std::string_view three_js();        ///< third_party/three/three.module.min.js
std::string_view page_template();   ///< the HTML page with @@PLACEHOLDERS@@
std::string_view page_style();      ///< its style sheet
std::string_view page_script();     ///< its scripts, in the order in which they build on each other
std::string_view batch_template();  ///< the same three of the page of a batch
std::string_view batch_style();
std::string_view batch_script();

}  // namespace photohull::page
