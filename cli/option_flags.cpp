#include "option_flags.h"

#include "cli/front/flag_words.h"
#include "core/error.h"

namespace photohull::cli {
namespace {

std::string help_of(const Option& option) {
  const std::string legal = legal_values(option);
  return legal.empty() ? option.help : option.help + " [" + legal + "]";
}

CLI::Option* add_flag(CLI::App& command, const Option& option) {
  const std::string flag = flag_of(option.name);
  if (std::holds_alternative<bool*>(option.place))
    return command.add_flag_callback(
        flag, [option] { read_option(option, "true"); }, option.help);
  if (option.list) {
    CLI::Option* added = command.add_option_function<std::vector<std::string>>(
        flag,
        [option](const std::vector<std::string>& items) {
          std::string list;
          for (const std::string& item : items) list += (list.empty() ? "" : ",") + item;
          read_option(option, list);
        },
        help_of(option));
    added->delimiter(',')->type_name("LIST");
    if (const std::string text = text_of(option); !text.empty()) added->default_str(text);
    return added;
  }
  if (std::holds_alternative<std::vector<std::string>*>(option.place))
    return command.add_option_function<std::vector<std::string>>(
        flag,
        [option](const std::vector<std::string>& texts) {
          for (const std::string& text : texts) read_option(option, text);
        },
        help_of(option));
  CLI::Option* added = command.add_option_function<std::string>(
      flag, [option](const std::string& text) { read_option(option, text); }, help_of(option));
  if (is_number(option)) added->type_name("NUMBER");
  if (const std::string text = text_of(option); !text.empty()) added->default_str(text);
  return added;
}

}  // namespace

std::vector<CLI::Option*> add_flags(CLI::App& command, const Described& described,
                                    const std::vector<std::string>& names) {
  std::vector<CLI::Option*> added;
  for (const std::string& name : names) {
    const Option* option = described.find(name);
    PHOTOHULL_CHECK(option);
    added.push_back(add_flag(command, *option));
  }
  if (names.empty())
    for (const Option& option : described.options()) added.push_back(add_flag(command, option));
  return added;
}

}  // namespace photohull::cli
