// Options described once. Of each field of a struct of options a function describe() beside the
// struct tells name, legal values, unit, meaning, and the first stage whose result it affects. From
// that come the command line and its help, checks, the report, --tune, the identity of a job and
// the reference page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace photohull {

/// What the main job makes, in this order. Each follows from those before it.
enum class Stage { kViews, kHull, kSurface, kMesh, kFiles, kNothing };

const char* to_string(Stage stage);

/// Finite numbers between two ends, which belong to them unless they are said to be open.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;

  bool holds(double value) const;
};

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr Range from_to(double low, double high) { return {low, high}; }
constexpr Range at_least(double low) { return {low, kUnbounded}; }
constexpr Range above(double low, double high = kUnbounded) { return {low, high, true}; }
/// From `low` on, below `high`.
constexpr Range below(double low, double high) { return {low, high, false, true}; }

/// A value that is neither a number nor plain text, as the command line writes it.
struct Words {
  std::function<std::string()> text;
  std::function<bool(const std::string&)> read;  ///< false, and nothing set: it is none
};

/// Where the value is. Nothing, in an optional one: decided by the job.
using Place = std::variant<bool*, int*, std::uint64_t*, double*, std::optional<int>*,
                           std::optional<double>*, std::optional<std::int64_t>*, std::vector<int>*,
                           std::vector<std::uint64_t>*, std::vector<double>*, std::string*,
                           std::filesystem::path*, std::vector<std::string>*, Words>;

/// One field of a struct of options, which must outlive it.
struct Option {
  std::string name;  ///< as the report has it, with the groups that it is in: "vote.band"
  Place place;
  std::string help;            ///< what it says, and why one would change it
  Stage from = Stage::kViews;  ///< the first stage whose result it affects
  Range range{};               ///< of numbers
  std::string unit{};          ///< of numbers; empty: none
  std::string zero{};          ///< what 0 means, where it is not a number like others
  std::string absent{};        ///< word for an optional number that is not given
  /// Reads a number that has a notation of its own; nothing: the text is none.
  std::function<std::optional<double>(const std::string&)> notation{};
  std::vector<std::string> choices{};  ///< all legal words; empty: any text
  std::string expects{};   ///< legal values for a sentence, where the above does not say it all
  std::string if_empty{};  ///< of text that may not be empty: what to write
  bool always = false;     ///< the report has it also where it is the default
  bool list = false;       ///< several values with commas between them, which replace the default
};

/// Collects what the functions describe() tell.
class Described {
 public:
  /// `place` of a number.
  Option& number(const std::string& name, Place place, const Range& range, const std::string& unit,
                 const std::string& help);
  /// On or off.
  Option& flag(const std::string& name, bool* place, const std::string& help);
  /// Numbers or texts with commas between them, each within the range; `what` they are stands in
  /// sentences about them.
  Option& list(const std::string& name, Place place, const Range& range, const std::string& what,
               const std::string& help);
  /// Text of any kind, or a value by its words.
  Option& text(const std::string& name, Place place, const std::string& help);
  /// One of an enumeration's `values`, by the names that its to_string gives; or an optional one.
  template <typename Field, typename Values>
  Option& choice(const std::string& name, Field* field, const Values& values,
                 const std::string& help);
  /// Options within others: their names get this one and a dot before them. The one called "" gets
  /// it without the dot.
  template <typename Options>
  void group(const std::string& name, Options& options);
  /// Options described after this have effect from this stage on; those of a group until its end.
  void affects(Stage stage) { from_ = stage; }
  /// What two options must be to each other: "belt", "must not exceed", "rings".
  void rule(bool holds, const std::string& one, const std::string& relation,
            const std::string& other);

  const std::vector<Option>& options() const { return options_; }
  /// Null where there is none.
  const Option* find(const std::string& name) const;
  /// Throws UsageError naming the first number out of its range, or the first rule that is broken
  /// (as the values were when they were described).
  void check() const;
  /// The same for options that programs are given by their names: worded as read_option does.
  void check_given() const;

 private:
  Option& add(const std::string& name, Place place, const std::string& help);
  std::string full_name(const std::string& name) const;

  std::vector<Option> options_;
  std::vector<std::string> broken_;
  std::string group_;
  Stage from_ = Stage::kViews;
};

/// Throws UsageError as Described::check does, for a struct that describe() describes.
template <typename Options>
void check_described(Options options) {
  Described to;
  describe(to, options);
  to.check();
}

/// The value, as read_option takes it; empty where there is none.
std::string text_of(const Option& option, int digits = 9);

/// Throws UsageError as Described::check_given does.
template <typename Options>
void check_options(Options options) {
  Described to;
  describe(to, options);
  to.check_given();
}

/// Sets the value; of texts that are no list, adds one. Throws UsageError, which names the option
/// (option_word.h) and what is legal.
void read_option(const Option& option, const std::string& text);

/// Throws UsageError, worded as read_option does, where a number is out of its range.
void check_option(const Option& option);

/// Legal values: "1 to 8", "auto, or at least 2", "draft, normal or high". Empty: any text.
std::string legal_values(const Option& option);

bool is_number(const Option& option);

template <typename Field, typename Values>
Option& Described::choice(const std::string& name, Field* field, const Values& values,
                          const std::string& help) {
  using Value = std::decay_t<decltype(*std::begin(values))>;
  const std::vector<Value> all(std::begin(values), std::end(values));
  Words words;
  words.text = [field]() -> std::string {
    if constexpr (std::is_same_v<Field, Value>)
      return to_string(*field);
    else
      return *field ? to_string(**field) : "";
  };
  words.read = [field, all](const std::string& text) {
    for (const Value& value : all)
      if (text == to_string(value)) {
        *field = value;
        return true;
      }
    return false;
  };
  Option& option = add(name, std::move(words), help);
  for (const Value& value : all) option.choices.emplace_back(to_string(value));
  return option;
}

template <typename Options>
void Described::group(const std::string& name, Options& options) {
  const std::string outer = std::exchange(group_, full_name(name) + ".");
  const Stage from = from_;
  describe(*this, options);
  group_ = outer;
  from_ = from;
}

}  // namespace photohull
