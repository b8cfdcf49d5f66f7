// How messages call options. A library's caller sets fields of structs, a user of the command line
// gives flags: the program says once which words its messages use.
#pragma once

#include <optional>
#include <string>
#include <type_traits>

#include "core/error.h"

namespace photohull {

/// The words of one kind of program. Names are those of described options (core/describe.h), with
/// underscores.
struct OptionWording {
  /// An option by itself, or with a value, which may be empty text.
  std::string (*option)(const std::string& name, const std::optional<std::string>& value);
  /// A command of the command line with an option that is on.
  std::string (*command)(const std::string& command, const std::string& option);
  /// Where to read more, at a sentence's end: "; see --help". Empty: nowhere.
  const char* more;
};

/// From here on, messages use these words; before, and in programs that set none, those of a
/// library: "mask_offset", "masks=none", "photohull info with cameras". Returns the words until
/// then. To be called at the program's start, before it has a second thread: it is not synchronised
/// with the functions below, which any number of threads may call.
OptionWording set_option_wording(const OptionWording& wording);

/// "mask_offset", or in the command line's words "--mask-offset".
std::string option_word(const std::string& name);
/// "masks=none", or "--masks none".
std::string option_word(const std::string& name, const std::string& value);
/// The same for values that are no text.
template <typename Value>
requires std::is_arithmetic_v<Value> std::string option_word(const std::string& name, Value value) {
  return option_word(name, concat(value));
}
/// "photohull info with cameras", or "photohull info --cameras".
std::string command_word(const std::string& command, const std::string& option);
/// What ends a sentence about a word that cannot be read: nothing, or "; see --help".
std::string where_to_read_more();

}  // namespace photohull
