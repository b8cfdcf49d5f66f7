#include "core/describe.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull {
namespace {

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;  // clang 14 does not deduce it

std::string written(double value, int digits = 9) {
  std::ostringstream out;
  out.precision(digits);
  out << value;
  return out.str();
}

/// What an option has one, at most one or several of.
template <typename T>
struct ItemOf {
  using Type = T;
};
template <typename T>
struct ItemOf<std::optional<T>> {
  using Type = T;
};
template <typename T>
struct ItemOf<std::vector<T>> {
  using Type = T;
};
template <typename T>
using Item = typename ItemOf<T>::Type;
template <typename T>
inline constexpr bool kIsNumber = std::is_arithmetic_v<Item<T>> && !std::is_same_v<T, bool>;

/// Does `what` with each number that the option has now; with none where it is none.
template <typename What>
void for_numbers(const Option& option, const What& what) {
  std::visit(Overloaded{[&]<typename T>(T* v) {
                          if constexpr (kIsNumber<T>) {
                            if constexpr (std::is_arithmetic_v<T>)
                              what(*v);
                            else if constexpr (std::is_same_v<T, std::vector<Item<T>>>)
                              std::for_each(v->begin(), v->end(), what);
                            else if (*v)
                              what(**v);
                          }
                        },
                        [](const Words&) {}},
             option.place);
}

/// Also where there is no number.
bool in_range(const Option& option) {
  bool all = true;
  for_numbers(option, [&](auto value) { all = all && option.range.holds(double(value)); });
  return all;
}

bool is_whole(const Option& option) {
  return std::visit(
      Overloaded{[]<typename T>(T*) { return kIsNumber<T> && std::is_integral_v<Item<T>>; },
                 [](const Words&) { return false; }},
      option.place);
}

std::string lowest(const Option& option) {
  const bool named = option.range.low == 0 && !option.zero.empty();
  return written(option.range.low) + (named ? " (" + option.zero + ")" : "");
}

std::string joined(const std::vector<std::string>& texts, const char* between) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : between) + text;
  return all;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> items;
  std::istringstream in(list);
  for (std::string item; std::getline(in, item, ',');) items.push_back(item);
  return items;
}

/// What is legal, for a sentence after the value: "expected 1 to 8".
std::string expectation(const Option& option) {
  if (!option.expects.empty()) return "expected " + option.expects;
  if (!option.choices.empty()) return "expected one of " + joined(option.choices, ", ");
  const Range& r = option.range;
  if (std::isinf(r.high)) {
    if (r.low_open)
      return r.low == 0 ? "must be finite and positive" : "must exceed " + lowest(option);
    return option.zero.empty() ? "at least " + lowest(option) : lowest(option) + " or more";
  }
  return "expected " + (option.absent.empty() ? "" : option.absent + ", or ") +
         (option.unit.empty() ? "" : option.unit + " from ") + lowest(option) + " to " +
         written(r.high);
}

/// The same for a sentence that begins with the option's name: "levels must be 0 to 8".
std::string obligation(const Option& option) {
  const Range& r = option.range;
  const std::string unit = option.unit.empty() ? "" : " " + option.unit;
  if (std::isinf(r.high)) {
    if (r.low == 0) return r.low_open ? "must be positive" : "must not be negative";
    return "must be at least " + written(r.low) + unit;
  }
  if (is_whole(option)) return "must be " + lowest(option) + " to " + written(r.high) + unit;
  return concat("must lie in ", r.low_open ? '(' : '[', written(r.low), ", ", written(r.high),
                r.high_open ? ')' : ']', unit);
}

[[noreturn]] void refuse(const Option& option, const std::string& text) {
  throw UsageError(concat(option_word(option.name, text), ": ", expectation(option)));
}

template <typename Number>
Number parsed(const Option& option, const std::string& text) {
  if (option.notation) {
    if (const std::optional<double> value = option.notation(text)) return Number(*value);
    refuse(option, text);
  }
  Number value{};
  bool whole = false;
  if constexpr (std::is_integral_v<Number>) {
    const char* end = text.data() + text.size();
    const auto [last, problem] = std::from_chars(text.data(), end, value);
    whole = problem == std::errc() && last == end;
  } else {
    char* end = nullptr;
    value = std::strtod(text.c_str(), &end);
    whole = end != text.c_str() && *end == 0;
  }
  if (whole) return value;
  if (!option.absent.empty() || !option.expects.empty()) refuse(option, text);
  throw UsageError(concat(option_word(option.name, text), ": expected a ",
                          std::is_integral_v<Number> ? "whole " : "", "number",
                          where_to_read_more()));
}

}  // namespace

const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::kViews:
      return "views";
    case Stage::kHull:
      return "hull";
    case Stage::kSurface:
      return "surface";
    case Stage::kMesh:
      return "mesh";
    case Stage::kFiles:
      return "files";
    case Stage::kNothing:
      return "nothing";
  }
  return "?";
}

bool Range::holds(double value) const {
  return std::isfinite(value) && (low_open ? value > low : value >= low) &&
         (high_open ? value < high : value <= high);
}

Option& Described::number(const std::string& name, Place place, const Range& range,
                          const std::string& unit, const std::string& help) {
  Option& option = add(name, std::move(place), help);
  option.range = range;
  option.unit = unit;
  return option;
}

Option& Described::flag(const std::string& name, bool* place, const std::string& help) {
  return add(name, place, help);
}

Option& Described::list(const std::string& name, Place place, const Range& range,
                        const std::string& what, const std::string& help) {
  Option& option = add(name, std::move(place), help);
  option.range = range;
  option.expects = what + ", with commas between them";
  option.list = true;
  return option;
}

Option& Described::text(const std::string& name, Place place, const std::string& help) {
  return add(name, std::move(place), help);
}

Option& Described::add(const std::string& name, Place place, const std::string& help) {
  Option option{.name = full_name(name), .place = std::move(place), .help = help};
  PHOTOHULL_CHECK(!find(option.name));
  option.from = from_;
  options_.push_back(std::move(option));
  return options_.back();
}

std::string Described::full_name(const std::string& name) const {
  return name.empty() ? group_.substr(0, group_.size() - 1) : group_ + name;
}

void Described::rule(bool holds, const std::string& one, const std::string& relation,
                     const std::string& other) {
  if (!holds) broken_.push_back(concat(full_name(one), " ", relation, " ", full_name(other)));
}

const Option* Described::find(const std::string& name) const {
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [&](const Option& option) { return option.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

void Described::check() const {
  for (const Option& option : options_)
    if (!in_range(option)) throw UsageError(concat(option.name, " ", obligation(option)));
  if (!broken_.empty()) throw UsageError(broken_.front());
}

void Described::check_given() const {
  for (const Option& option : options_) check_option(option);
  if (!broken_.empty()) throw UsageError(broken_.front());
}

std::string text_of(const Option& option, int digits) {
  std::vector<std::string> numbers;
  for_numbers(option, [&](auto value) {
    if constexpr (std::is_integral_v<decltype(value)>)
      numbers.push_back(concat(value));
    else
      numbers.push_back(written(value, digits));
  });
  if (!numbers.empty()) return joined(numbers, ",");
  return std::visit(
      Overloaded{
          [](bool* v) -> std::string { return *v ? "true" : ""; },
          [](std::string* v) { return *v; }, [](std::filesystem::path* v) { return v->string(); },
          [&](std::vector<std::string>* v) { return joined(*v, option.list ? "," : " "); },
          [](const Words& v) { return v.text(); }, [&](const auto&) { return option.absent; }},
      option.place);
}

void read_option(const Option& option, const std::string& text) {
  if (text.empty() && !option.if_empty.empty())
    throw UsageError(concat(option_word(option.name), " is empty: ", option.if_empty));
  const bool absent = !option.absent.empty() && text == option.absent;
  const auto read_number = [&]<typename T>(T* v) {
    if constexpr (std::is_same_v<T, std::vector<Item<T>>>) {
      v->clear();
      for (const std::string& item : split(text)) v->push_back(parsed<Item<T>>(option, item));
    } else if (absent) {
      *v = T();
    } else {
      *v = parsed<Item<T>>(option, text);
    }
  };
  std::visit(Overloaded{[&](bool* v) { *v = text == "true"; }, [&](std::string* v) { *v = text; },
                        [&](std::filesystem::path* v) { *v = text; },
                        [&](std::vector<std::string>* v) {
                          if (option.list)
                            *v = split(text);
                          else
                            v->push_back(text);
                        },
                        [&](const Words& v) {
                          if (!v.read(text)) refuse(option, text);
                        },
                        [&](auto* v) { read_number(v); }},
             option.place);
  if (!in_range(option)) refuse(option, text);
}

void check_option(const Option& option) {
  if (!in_range(option)) refuse(option, text_of(option));
}

bool is_number(const Option& option) {
  return std::visit(
      Overloaded{[]<typename T>(T*) { return kIsNumber<T>; }, [](const Words&) { return false; }},
      option.place);
}

std::string legal_values(const Option& option) {
  std::string list;
  for (const std::string& choice : option.choices)
    list += (list.empty() ? "" : choice == option.choices.back() ? " or " : ", ") + choice;
  if (!list.empty()) return list;
  if (!option.expects.empty()) return option.expects;
  if (!is_number(option)) return "";
  const Range& r = option.range;
  const std::string word = option.absent.empty() ? "" : option.absent + ", or ";
  const std::string low = (r.low_open ? "above " : "") + lowest(option);
  if (!std::isinf(r.high))
    return concat(word, low, r.high_open ? " to below " : " to ", written(r.high));
  if (r.low_open) return word + low;
  return word + (option.zero.empty() ? "at least " + low : low + " or more");
}

}  // namespace photohull
