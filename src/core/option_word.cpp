#include "core/option_word.h"

#include <utility>

namespace photohull {
namespace {

std::string field_word(const std::string& name, const std::optional<std::string>& value) {
  return value ? name + "=" + *value : name;
}

std::string command_with_field(const std::string& command, const std::string& option) {
  return "photohull " + command + " with " + option;
}

OptionWording wording = {field_word, command_with_field, ""};

}  // namespace

OptionWording set_option_wording(const OptionWording& chosen) {
  return std::exchange(wording, chosen);
}

std::string option_word(const std::string& name) { return wording.option(name, std::nullopt); }

std::string option_word(const std::string& name, const std::string& value) {
  return wording.option(name, value);
}

std::string command_word(const std::string& command, const std::string& option) {
  return wording.command(command, option);
}

std::string where_to_read_more() { return wording.more; }

}  // namespace photohull
