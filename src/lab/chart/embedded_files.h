// Text files that are part of the program. Private to lab.
#pragma once

#include <string_view>

namespace photohull::chart {

std::string_view echarts_js();     ///< third_party/echarts/echarts.min.js
std::string_view render_svg_js();  ///< what Duktape runs before and after it
std::string_view page_template();  ///< the HTML page with @PLACEHOLDERS@

}  // namespace photohull::chart
