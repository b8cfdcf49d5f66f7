// Pages made of a template with places for what differs.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace photohull {

/// The template with each @@NAME@@ replaced by what `part` gives for its name.
std::string fill_template(std::string_view page,
                          const std::function<std::string(std::string_view)>& part);

/// JSON that may stand inside a <script> element: nothing in it ends the element.
std::string inside_script(std::string_view json);

}  // namespace photohull
