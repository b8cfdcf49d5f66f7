// Which part of a scene, of how many.
#pragma once

#include <optional>
#include <string>

#include "core/describe.h"

namespace photohull::pipeline {

struct PartNumber {
  static constexpr int kMost = 100000;
  int number = 1, count = 1;  ///< 1 <= number <= count <= kMost
};

/// "3/8".
std::string to_string(const PartNumber& part);
/// Nothing: the text is none.
std::optional<PartNumber> parse_part(const std::string& text);
/// The same as an option, which is "all" where there is none.
Words part_words(std::optional<PartNumber>& part);

}  // namespace photohull::pipeline
