#include "cli/front/parse_faults.h"

#include <algorithm>

#include "core/error.h"
#include "core/nearest_name.h"

namespace photohull::cli {
namespace {

/// The parser's message as one sentence.
std::string one_line(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  while (!message.empty() && (message.back() == ' ' || message.back() == '.')) message.pop_back();
  return message;
}

std::string meant(const std::string& name, const std::vector<std::string>& names) {
  const auto near = nearest_name(name, names);
  return near ? "; did you mean " + *near + "?" : "; see --help";
}

/// The app, or the command of it that was chosen.
const CLI::App& innermost(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : innermost(*chosen.front());
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// The parser's words for values that are missing, of the wrong kind or too many, in a sentence.
std::string said_plainly(const CLI::App& command, const std::string& message) {
  const std::string missing = ": 1 required ", kind = "Could not convert: ",
                    surplus = "The following argument was not expected: ";
  if (const std::size_t at = message.find(missing);
      at != std::string::npos && message.ends_with(" missing"))
    return message.substr(0, at) + ": its value is missing";
  if (message.starts_with(surplus))
    return concat("'", message.substr(surplus.size()), "' belongs to no option");
  const std::size_t equals = message.find(" = ");
  if (!message.starts_with(kind) || equals == std::string::npos) return message;
  const std::string name = message.substr(kind.size(), equals - kind.size());
  const CLI::Option* option = command.get_option_no_throw(name);
  const bool whole = option && option->get_type_name() == "INT";
  return concat(name, " ", message.substr(equals + 3), ": expected a ", whole ? "whole " : "",
                "number");
}

}  // namespace

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::string parse_fault(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  const std::vector<std::string> unknown = app.remaining(true), commands = command_names(command);
  for (const std::string& word : unknown) {
    if (!word.starts_with("-") && !commands.empty())
      return concat("there is no command ", word, meant(word, commands));
    if (!word.starts_with("--") || word == "--") continue;
    const std::string name = word.substr(0, word.find('='));
    const std::string where = &command == &app ? "" : " of photohull " + command.get_name();
    return concat("there is no option ", name, where, meant(name, option_names(command)));
  }
  return said_plainly(command, one_line(error.what())) + "; see --help";
}

}  // namespace photohull::cli
