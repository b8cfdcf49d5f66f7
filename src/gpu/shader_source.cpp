#include "gpu/shader_source.h"

#include <algorithm>
#include <set>

#include "core/error.h"

namespace photohull::gpu {
namespace {

int find_shader(std::string_view path) {
  const auto shaders = embedded_shaders();
  const auto it = std::find_if(shaders.begin(), shaders.end(),
                               [&](const EmbeddedShader& s) { return s.path == path; });
  if (it == shaders.end()) check_failed("shaders", 0, "no embedded shader " + std::string(path));
  return int(it - shaders.begin());
}

constexpr std::string_view kIncludeInstead = "// include_instead ";

/// The file that is included where `path` is, by lines of include_instead.
std::string_view included(std::string_view path, std::string_view defines) {
  for (std::size_t at = defines.find(kIncludeInstead); at != std::string_view::npos;
       at = defines.find(kIncludeInstead, at + 1)) {
    const std::string_view rest = defines.substr(at + kIncludeInstead.size());
    const std::size_t space = rest.find(' ');
    if (rest.substr(0, space) == path) return rest.substr(space + 1, rest.find('\n') - space - 1);
  }
  return path;
}

void append_file(std::string_view path, std::string_view defines, std::set<int>& seen,
                 std::string& out) {
  const int number = find_shader(path);
  if (!seen.insert(number).second) return;
  out += concat("#line 1 ", number, "\n");
  std::string_view text = embedded_shaders()[number].text;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view row = text.substr(0, end);
    text.remove_prefix(end);
    // The entry point's own #version and include extension are for the linter, <headers> for C++.
    if (row.starts_with("#version") || row.starts_with("#include <") ||
        row.starts_with("#extension GL_GOOGLE_include_directive")) {
      out += "\n";
    } else if (row.starts_with("#include")) {
      const std::size_t open = row.find('"'), close = row.rfind('"');
      PHOTOHULL_CHECK(open != close);
      append_file(included(row.substr(open + 1, close - open - 1), defines), defines, seen, out);
      out += concat("#line ", line + 1, " ", number, "\n");
    } else {
      out += row;
    }
  }
}

}  // namespace

std::string expand_shader(std::string_view path, std::string_view defines) {
  std::string out = "#version 450 core\n";
  out += defines;
  std::set<int> seen;
  append_file(path, defines, seen, out);
  return out;
}

std::string shader_file(int number) {
  const auto shaders = embedded_shaders();
  return number >= 0 && number < int(shaders.size()) ? std::string(shaders[number].path) : "?";
}

std::string define(std::string_view prefix, std::string_view name) {
  std::string line = "#define " + std::string(prefix);
  for (const char c : name) line += c == '-' ? '_' : c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  return line + '\n';
}

std::string include_instead(std::string_view file, std::string_view other) {
  return concat(kIncludeInstead, file, " ", other, "\n");
}

}  // namespace photohull::gpu
