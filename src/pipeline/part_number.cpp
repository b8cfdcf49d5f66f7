#include "pipeline/part_number.h"

#include <charconv>

#include "core/error.h"

namespace photohull::pipeline {

std::string to_string(const PartNumber& part) { return concat(part.number, "/", part.count); }

std::optional<PartNumber> parse_part(const std::string& text) {
  PartNumber out;
  const char* end = text.data() + text.size();
  const auto [bar, fault] = std::from_chars(text.data(), end, out.number);
  if (fault != std::errc() || bar == end || *bar != '/') return std::nullopt;
  const auto [last, other] = std::from_chars(bar + 1, end, out.count);
  const bool legal = out.number >= 1 && out.number <= out.count && out.count <= PartNumber::kMost;
  if (other != std::errc() || last != end || !legal) return std::nullopt;
  return out;
}

Words part_words(std::optional<PartNumber>& part) {
  return {[&part] { return part ? to_string(*part) : std::string("all"); },
          [&part](const std::string& text) {
            const std::optional<PartNumber> read = parse_part(text);
            if (read || text == "all") part = read;
            return read || text == "all";
          }};
}

}  // namespace photohull::pipeline
