#include "cli/front/flag_words.h"

#include <algorithm>
#include <optional>

namespace photohull::cli {
namespace {

std::string flag_with_value(const std::string& name, const std::optional<std::string>& value) {
  return value ? flag_of(name) + " " + *value : flag_of(name);
}

std::string command_with_flag(const std::string& command, const std::string& option) {
  return "photohull " + command + " " + flag_of(option);
}

}  // namespace

std::string flag_of(const std::string& name) {
  std::string flag = "--" + name;
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

OptionWording flag_wording() { return {flag_with_value, command_with_flag, "; see --help"}; }

}  // namespace photohull::cli
