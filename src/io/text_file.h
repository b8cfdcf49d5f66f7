// Text scene files, line by line, with errors that name file, line and field. Internal to io.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace photohull::io {

/// Larger text and JSON files are refused: no scene needs them, and they are read as a whole.
inline constexpr std::uintmax_t kMaxTextFileBytes = std::uintmax_t(512) << 20;

/// Is there a regular file (or a link to one)? Never throws.
bool is_file(const std::filesystem::path& path);

/// The whole file without a UTF-8 byte order mark. Throws Error when it is missing, unreadable,
/// not a regular file or larger than kMaxTextFileBytes.
std::string read_text_file(const std::filesystem::path& path);

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// Fields between blanks; at most `limit` of them, the rest of the line is not looked at.
std::vector<std::string_view> split_fields(std::string_view line, std::size_t limit = SIZE_MAX);

/// A decimal number that fills the whole token (NaN and infinities included), or nothing.
/// Independent of the locale.
std::optional<double> parse_double(std::string_view token);
std::optional<std::int64_t> parse_integer(std::string_view token);

/// All numbers of a file of exactly `count`, between blanks and line ends. Throws Error otherwise.
std::vector<double> read_numbers(const std::filesystem::path& file, std::size_t count);

/// Walks over a file's lines.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file);
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  /// Steps to the next line; false at the end of the file.
  bool next();
  /// Steps to the next line that is neither blank nor a # comment.
  bool next_content();
  /// The current line without blanks at its ends.
  std::string_view text() const { return line_; }
  /// "FILE line 12", to open an error message.
  std::string where() const;
  /// A finite number of the current line; throws Error naming file, line, field and token.
  double number(std::string_view token, std::string_view field) const;
  std::int64_t integer(std::string_view token, std::string_view field) const;

 private:
  std::filesystem::path file_;
  std::string text_;
  std::size_t position_ = 0;
  std::string_view line_;
  int number_ = 0;
};

}  // namespace photohull::io
