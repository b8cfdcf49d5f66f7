// OFF files, trusting nothing in them: memory grows with the lines that are there, not with the
// counts of the header. Format: Geomview's manual, "OFF Files".
#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include "core/error.h"
#include "io/mesh/mesh_soup.h"

namespace photohull {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// Lines that hold something besides a comment.
class OffLines {
 public:
  explicit OffLines(const std::filesystem::path& path) : path_(path), in_(path, std::ios::binary) {}

  [[noreturn]] void fail(const std::string& what) const {
    fail_to_read(path_, concat("line ", number_, ": ", what), "give a complete OFF file in ASCII");
  }
  /// Steps to the next line; false at the end.
  bool next() {
    while (std::getline(in_, line_)) {
      ++number_;
      rest_ = std::string_view(line_).substr(0, line_.find('#'));
      if (rest_.find_first_not_of(kBlanks) != std::string_view::npos) return true;
    }
    rest_ = {};
    return false;
  }
  /// The line's next word; empty at its end.
  std::string_view word() {
    const std::size_t begin = rest_.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return rest_ = {};
    const std::size_t end = std::min(rest_.find_first_of(kBlanks, begin), rest_.size());
    const std::string_view found = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return found;
  }
  template <typename Number>
  Number number(const char* what) {
    std::string_view text = word();
    if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size())
      fail(concat(what, " is missing or no number"));
    return value;
  }

 private:
  std::filesystem::path path_;
  std::ifstream in_;
  std::string line_;
  std::string_view rest_;
  std::size_t number_ = 0;
};

bool is_keyword(std::string_view word) {
  static constexpr std::string_view kKnown[] = {"OFF",   "COFF",   "NOFF",   "CNOFF",
                                                "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
  return std::find(std::begin(kKnown), std::end(kKnown), word) != std::end(kKnown);
}

struct Counts {
  std::uint32_t vertices = 0;
  std::uint64_t faces = 0;
};

/// The keyword, and the counts behind it or on the next line.
Counts read_header(OffLines& lines) {
  if (!lines.next() || !is_keyword(lines.word()))
    lines.fail("its header is malformed: it must start with OFF");
  std::string_view first = lines.word();
  if (first.empty()) {
    if (!lines.next()) lines.fail("its header ends before the numbers of vertices and faces");
    first = lines.word();
  }
  Counts counts;
  const auto [end, error] =
      std::from_chars(first.data(), first.data() + first.size(), counts.vertices);
  if (error != std::errc() || end != first.data() + first.size())
    lines.fail("its header has no number of vertices below 2^32");
  counts.faces = lines.number<std::uint64_t>("the number of faces");
  return counts;
}

void read_face(OffLines& lines, std::uint32_t vertices, Soup& soup) {
  const auto corners = lines.number<std::uint64_t>("the face's number of corners");
  std::array<std::uint32_t, 3> triangle{};
  for (std::uint64_t i = 0; i < corners; ++i) {
    const auto index = lines.number<std::uint64_t>("a face's index");
    if (index >= vertices)
      lines.fail(
          concat("the index ", index, " is out of range: there are ", vertices, " vertices"));
    triangle[std::min<std::uint64_t>(i, 2)] = std::uint32_t(index);
    if (i < 2) continue;
    soup.triangles.push_back(triangle);
    triangle[1] = triangle[2];
  }
}

}  // namespace

Soup read_off(const std::filesystem::path& path) {
  OffLines lines(path);
  const Counts counts = read_header(lines);
  Soup soup;
  const auto step = [&](const char* what, std::uint64_t done, std::uint64_t wanted) {
    if (!lines.next())
      lines.fail(concat("it is too short: ", done, " of ", wanted, " ", what, " are there"));
  };
  for (std::uint32_t v = 0; v < counts.vertices; ++v) {
    step("vertices", v, counts.vertices);
    glm::dvec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = lines.number<double>("a coordinate");
    soup.positions.push_back(p);
  }
  for (std::uint64_t f = 0; f < counts.faces; ++f) {
    step("faces", f, counts.faces);
    read_face(lines, counts.vertices, soup);
  }
  return soup;
}

}  // namespace photohull
