#include "pipeline/given_words.h"

#include "core/option_word.h"
#include "core/shell_word.h"

namespace photohull::pipeline {
namespace {

std::string words_of(const Option& option) {
  if (std::holds_alternative<bool*>(option.place)) return " " + option_word(option.name);
  std::string words;
  if (const auto* texts = std::get_if<std::vector<std::string>*>(&option.place);
      texts && !option.list) {
    for (const std::string& text : **texts)
      words += " " + option_word(option.name, shell_word(text));
    return words;
  }
  return " " + option_word(option.name, shell_word(text_of(option)));
}

}  // namespace

std::string given_words(ReconstructOptions options, io::LoadSceneOptions load) {
  ReconstructOptions defaults;
  io::LoadSceneOptions usual_load;
  Described given, usual;
  describe(given, options, load);
  describe(usual, defaults, usual_load);
  std::string words;
  for (const Option& option : given.options())
    if (text_of(option) != text_of(*usual.find(option.name))) words += words_of(option);
  return words;
}

}  // namespace photohull::pipeline
