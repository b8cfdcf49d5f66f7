// Numbers as an option's value.
#pragma once

#include <string>
#include <vector>

namespace photohull::cli {

/// Finite numbers between blanks or commas. Throws UsageError naming the option for anything else
/// and for none.
std::vector<double> parse_numbers(const std::string& option, const std::string& text);

}  // namespace photohull::cli
