#include "number_list.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"

namespace photohull::cli {

std::vector<double> parse_numbers(const std::string& option, const std::string& text) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream in(spaced);
  std::vector<double> numbers;
  for (std::string token; in >> token;) {
    std::size_t used = 0;
    double value = NAN;
    try {
      value = std::stod(token, &used);
    } catch (const std::exception&) {
      used = 0;  // no number, or one out of range
    }
    if (used != token.size() || !std::isfinite(value))
      throw UsageError(concat(option, ": '", token, "' is no number"));
    numbers.push_back(value);
  }
  if (numbers.empty()) throw UsageError(option + " is empty: give numbers");
  return numbers;
}

}  // namespace photohull::cli
