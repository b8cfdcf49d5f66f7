#include "pipeline/tuning.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "core/error.h"
#include "core/option_word.h"
#include "pipeline/methods/method.h"

namespace photohull::pipeline {
namespace {

std::string name_in(const std::string& assignment) {
  return assignment.substr(0, assignment.find('='));
}

[[noreturn]] void refuse(const std::string& assignment, const std::string& why) {
  throw UsageError(concat(option_word("tune", assignment), ": ", why));
}

std::string known_names(const Described& parameters) {
  std::vector<std::string> names;
  for (const Option& option : parameters.options())
    if (option_that_sets(option.name).empty()) names.push_back(option.name);
  std::sort(names.begin(), names.end());
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

double value_in(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string number = equals == std::string::npos ? "" : assignment.substr(equals + 1);
  char* end = nullptr;
  const double value = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != 0 || !std::isfinite(value) ||
      std::abs(value) > std::numeric_limits<int>::max())
    refuse(assignment, "expected NAME=NUMBER");
  return value;
}

void assign(const std::string& assignment, const Option& option) {
  const double value = value_in(assignment);
  const auto set = [&](auto* place) {
    *place = static_cast<std::decay_t<decltype(*place)>>(value);
    if (double(*place) != value) refuse(assignment, "expected a whole number, 0 or 1 for a switch");
  };
  if (bool* const* on = std::get_if<bool*>(&option.place))
    set(*on);
  else if (int* const* whole = std::get_if<int*>(&option.place))
    set(*whole);
  else
    set(std::get<double*>(option.place));
}

}  // namespace

std::string option_that_sets(const std::string& parameter) {
  if (parameter == "noise_sigma") return "noise";
  if (parameter == "search_radius") return "r_consistency";
  return parameter == "supersample" ? parameter : "";
}

void describe(Described& to, Method method, Parameters& parameters) {
  to.group("missing", parameters.missing);
  to.group("stems", parameters.stems);
  if (const auto own = method_of(method).describe) own(to, parameters);
}

void tune(const std::vector<std::string>& assignments, Method method, Parameters& parameters) {
  Described known;
  describe(known, method, parameters);
  for (const std::string& assignment : assignments) {
    const std::string name = name_in(assignment);
    if (const std::string option = option_that_sets(name); !option.empty())
      refuse(assignment, concat("this is an option of its own: ", option_word(option)));
    if (const Option* option = known.find(name))
      assign(assignment, *option);
    else
      refuse(assignment, concat("this method has no '", name, "'; it has ", known_names(known)));
  }
  Described changed;
  describe(changed, method, parameters);
  changed.check();
}

Parameters tuned(const ReconstructOptions& options) {
  Parameters parameters;
  tune(options.tune, options.effective_method(), parameters);
  return parameters;
}

std::vector<std::string> assignments_until(Stage last, const ReconstructOptions& options) {
  Parameters parameters;
  Described known;
  describe(known, options.effective_method(), parameters);
  std::vector<std::string> out;
  std::copy_if(options.tune.begin(), options.tune.end(), std::back_inserter(out),
               [&](const std::string& assignment) {
                 const Option* option = known.find(name_in(assignment));
                 return option && option->from <= last;
               });
  return out;
}

}  // namespace photohull::pipeline
