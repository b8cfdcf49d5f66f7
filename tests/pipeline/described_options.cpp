#include "described_options.h"

#include <cstdlib>

#include "core/error.h"

namespace photohull::pipeline {

namespace {

/// A legal number that is not the option's.
std::string other_number(const Option& option) {
  const double now = std::strtod(text_of(option).c_str(), nullptr);
  const bool real = std::holds_alternative<double*>(option.place);
  const double near = real ? 0.01 : 1;  // which breaks no rule between two options
  for (double other : {now + near, now - near, option.range.low})
    if (other != now && option.range.holds(other)) return text_of({.name = "", .place = &other});
  return "";
}

}  // namespace

std::string assignment_of(const Option& parameter) {
  const bool* const* on = std::get_if<bool*>(&parameter.place);
  return parameter.name + "=" + (on ? concat(!**on) : other_number(parameter));
}

void change(const Option& option) {
  const std::string now = text_of(option);
  if (std::holds_alternative<bool*>(option.place)) {
    read_option(option, now == "true" ? "false" : "true");
  } else if (is_number(option) && !option.notation && option.expects.empty()) {
    read_option(option, other_number(option));
  } else if (!option.choices.empty()) {
    read_option(option,
                option.choices.front() == now ? option.choices.back() : option.choices.front());
  } else {
    // The first that is legal, of what options with a notation of their own take.
    for (const char* text :
         {"levels=3", "0 0 0 1 1 1", "keep", "1/2", "2G", "0.5u", "2", "1", "512"})
      try {
        read_option(option, text);
        if (text_of(option) != now) return;
      } catch (const Error&) {
      }
  }
}

}  // namespace photohull::pipeline
