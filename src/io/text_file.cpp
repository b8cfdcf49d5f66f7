#include "io/text_file.h"

#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/read_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

/// from_chars takes no plus sign, people write them.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  return token;
}

template <typename T>
std::optional<T> parse_whole(std::string_view token) {
  token = without_plus(token);
  T value{};
  const char* end = token.data() + token.size();
  const auto [stop, failure] = std::from_chars(token.data(), end, value);
  if (failure != std::errc() || stop != end || token.empty()) return std::nullopt;
  return value;
}

/// A token for an error message: short, and printable whatever the file holds.
std::string shown(std::string_view token) {
  std::string text(token.substr(0, 40));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32) c = '?';
  return text + (token.size() > 40 ? "..." : "");
}

}  // namespace

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::string read_text_file(const fs::path& path) {
  if (!is_file(path)) throw Error(concat(path.string(), ": there is no such file"));
  std::error_code failure;
  const std::uintmax_t size = fs::file_size(path, failure);
  if (!failure && size > kMaxTextFileBytes)
    throw Error(concat(path.string(), ": ", size >> 20,
                       " MiB are too much for a text file (at most ", kMaxTextFileBytes >> 20,
                       "); use a binary format or fewer views"));
  std::string text = read_whole_file(path);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return text;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> split_fields(std::string_view line, std::size_t limit) {
  std::vector<std::string_view> fields;
  std::size_t begin = line.find_first_not_of(kBlanks);
  while (begin != std::string_view::npos && fields.size() < limit) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

std::optional<double> parse_double(std::string_view token) { return parse_whole<double>(token); }

std::optional<std::int64_t> parse_integer(std::string_view token) {
  return parse_whole<std::int64_t>(token);
}

Lines::Lines(const fs::path& file) : file_(file), text_(read_text_file(file)) {}

bool Lines::next() {
  if (position_ >= text_.size()) return false;
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  line_ = trimmed(std::string_view(text_).substr(position_, end - position_));
  position_ = end + 1;
  ++number_;
  return true;
}

bool Lines::next_content() {
  while (next())
    if (!line_.empty() && line_[0] != '#') return true;
  return false;
}

std::string Lines::where() const { return concat(file_.string(), " line ", number_); }

double Lines::number(std::string_view token, std::string_view field) const {
  const auto value = parse_double(token);
  if (!value || !std::isfinite(*value))
    throw Error(concat(where(), ": ", field, " is '", shown(token), "', not a finite number"));
  return *value;
}

std::int64_t Lines::integer(std::string_view token, std::string_view field) const {
  const auto value = parse_integer(token);
  if (!value)
    throw Error(concat(where(), ": ", field, " is '", shown(token), "', not a whole number"));
  return *value;
}

std::vector<double> read_numbers(const fs::path& file, std::size_t count) {
  std::vector<double> values;
  Lines lines(file);
  while (lines.next_content())
    for (const std::string_view field : split_fields(lines.text(), count + 1))
      values.push_back(lines.number(field, concat("number ", values.size() + 1)));
  if (values.size() != count)
    throw Error(
        concat(file.string(), ": ", values.size(), " numbers found, but ", count, " are needed"));
  return values;
}

}  // namespace photohull::io
