#include "calib/turntable_angles.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull {
namespace {

/// Finite numbers between blanks or commas; nothing for anything else and for none.
std::optional<std::vector<double>> numbers_in(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  std::vector<double> numbers;
  for (std::string token; in >> token;) {
    std::size_t used = 0;
    double value = NAN;
    try {
      value = std::stod(token, &used);
    } catch (const std::exception&) {
      return std::nullopt;  // no number, or one out of range
    }
    if (used != token.size() || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
  }
  if (numbers.empty()) return std::nullopt;
  return numbers;
}

std::string text_of_numbers(const std::vector<double>& numbers) {
  std::ostringstream out;
  for (std::size_t i = 0; i < numbers.size(); ++i) out << (i ? " " : "") << numbers[i];
  return out.str();
}

}  // namespace

std::vector<double> TurntableAngles::of(std::size_t photographs) const {
  if (step && !angles.empty())
    throw UsageError(
        concat(option_word("step"), " and ", option_word("angles"), ": give one of them"));
  if (!step) return angles;
  std::vector<double> all;
  for (std::size_t i = 0; i < photographs; ++i) all.push_back(double(i) * *step);
  return all;
}

void describe(Described& to, TurntableAngles& o) {
  to.number("step", &o.step, from_to(-180, 180), "degrees",
            "turntable: from each photograph to the next, in natural order of names, where they "
            "are known")
      .absent = "none";
  Words words;
  words.text = [&o] { return text_of_numbers(o.angles); };
  words.read = [&o](const std::string& text) {
    const auto numbers = numbers_in(text);
    if (numbers) o.angles = *numbers;
    return numbers.has_value();
  };
  to.text("angles", words, "turntable: degrees of each photograph, such as \"0 7.5 20\"").expects =
      "degrees, with blanks or commas between them";
}

}  // namespace photohull
