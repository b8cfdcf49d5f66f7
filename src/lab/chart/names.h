// Names that become labels and file names. Private to lab.
#pragma once

#include <optional>
#include <string>

namespace photohull::chart {

/// What is wrong with a label: braces and bars have a meaning in chart templates.
inline std::optional<std::string> label_fault(const std::string& name) {
  if (name.empty() || name.size() > 60) return "a name has 1 to 60 characters";
  for (const unsigned char c : name)
    if (c < 0x20 || c == 0x7f || c == '{' || c == '}' || c == '|')
      return "the name '" + name + "' has a control character, a brace or a bar";
  return std::nullopt;
}

/// What is wrong with a name that is to be part of a file's.
inline std::optional<std::string> file_name_fault(const std::string& name) {
  bool good = !name.empty() && name.size() <= 60 && name[0] != '.';
  for (const char c : name)
    good = good && ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                    c == '.' || c == '_' || c == '-');
  if (good) return std::nullopt;
  return "the scene's name '" + name +
         "' must be letters, digits, '.', '_' and '-' (at most 60); give it another \"name\"";
}

}  // namespace photohull::chart
