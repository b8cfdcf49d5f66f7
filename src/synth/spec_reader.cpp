#include "synth/spec_reader.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/nearest_name.h"
#include "synth/spec_visit.h"

namespace photohull::synth {

using Json = nlohmann::json;

namespace {

constexpr std::size_t kLongestList = 100000;

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

/// A value as it would stand in the file, cut short.
std::string shown(const Json& j) {
  std::string text = j.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

}  // namespace

SpecReader::SpecReader(const Json& root, std::string source)
    : object_(&root), source_(std::move(source)) {
  if (!root.is_object()) fail("", "expected an object { ... }, found " + shown(root));
}

const Json* SpecReader::take(const char* name) {
  known_.insert(name);
  const auto found = object_->find(name);
  return found == object_->end() ? nullptr : &*found;
}

std::string SpecReader::path(const std::string& name) const {
  return path_.empty() ? name : path_ + "." + name;
}

void SpecReader::fail(const std::string& place, const std::string& what) const {
  throw Error(source_ + ": " + (place.empty() ? "" : place + ": ") + what);
}

double SpecReader::checked(const Json& j, const std::string& place, double low, double high) const {
  if (!j.is_number()) fail(place, "expected a number, found " + shown(j));
  const double value = j.get<double>();
  if (!(value >= low && value <= high))
    fail(place, concat("expected a number from ", low, " to ", high, ", found ", shown(j)));
  return value;
}

int SpecReader::checked_integer(const Json& j, const std::string& place, int low, int high) const {
  const double value = checked(j, place, low, high);
  if (value != std::floor(value)) fail(place, "expected a whole number, found " + shown(j));
  return int(value);
}

std::vector<double> SpecReader::number_list(const Json& j, const std::string& place, double low,
                                            double high) const {
  check_list(j, place);
  std::vector<double> values;
  for (std::size_t i = 0; i < j.size(); ++i)
    values.push_back(checked(j[i], place + "[" + std::to_string(i) + "]", low, high));
  return values;
}

void SpecReader::check_list(const Json& j, const std::string& place) const {
  if (!j.is_array()) fail(place, "expected a list [ ... ], found " + shown(j));
  if (j.size() > kLongestList)
    fail(place, concat("the list has ", j.size(), " entries, more than ", kLongestList));
}

void SpecReader::enter(const Json& j, const std::string& place) {
  if (!j.is_object()) fail(place, "expected an object { ... }, found " + shown(j));
  object_ = &j;
  path_ = place;
  known_.clear();
}

void SpecReader::number(const char* name, double& value, double low, double high) {
  if (const Json* j = take(name)) value = checked(*j, path(name), low, high);
}

void SpecReader::integer(const char* name, int& value, int low, int high) {
  if (const Json* j = take(name)) value = checked_integer(*j, path(name), low, high);
}

void SpecReader::seed(const char* name, std::uint64_t& value) {
  const Json* j = take(name);
  if (!j) return;
  if (!j->is_number_unsigned())
    fail(path(name), "expected a whole number that is not negative, found " + shown(*j));
  value = j->get<std::uint64_t>();
}

void SpecReader::flag(const char* name, bool& value) {
  const Json* j = take(name);
  if (!j) return;
  if (!j->is_boolean()) fail(path(name), "expected true or false, found " + shown(*j));
  value = j->get<bool>();
}

void SpecReader::text(const char* name, std::string& value) {
  const Json* j = take(name);
  if (!j) return;
  if (!j->is_string()) fail(path(name), "expected a text in quotes, found " + shown(*j));
  value = j->get<std::string>();
}

void SpecReader::choice(const char* name, std::string& value, std::vector<std::string> choices) {
  std::string text_value = value;
  text(name, text_value);
  if (std::find(choices.begin(), choices.end(), text_value) == choices.end()) {
    const auto near = nearest_name(text_value, choices);
    fail(path(name), "expected one of " + joined(choices) + ", found \"" + text_value + "\"" +
                         (near ? "; did you mean " + *near + "?" : ""));
  }
  value = text_value;
}

void SpecReader::numbers(const char* name, std::vector<double>& value, double low, double high) {
  const Json* j = take(name);
  if (!j) return;
  value = number_list(*j, path(name), low, high);
  if (value.empty()) fail(path(name), "expected one number at least, found none");
}

void SpecReader::integers(const char* name, std::vector<int>& value, int low, int high) {
  const Json* j = take(name);
  if (!j) return;
  const std::string place = path(name);
  check_list(*j, place);
  value.clear();
  for (std::size_t i = 0; i < j->size(); ++i)
    value.push_back(checked_integer((*j)[i], place + "[" + std::to_string(i) + "]", low, high));
}

void SpecReader::shape(GeometrySpec& geometry) {
  text("mesh", geometry.mesh);
  if (!geometry.mesh.empty()) {
    geometry.shape.clear();
    std::string given;
    text("shape", given);
    if (!given.empty()) fail(path("mesh"), "give either a shape or a mesh, not both");
    return;
  }
  std::vector<std::string> names;
  for (const Shape& s : shapes()) names.push_back(s.name);
  choice("shape", geometry.shape, names);
  const Shape& chosen = *find_shape(geometry.shape);
  geometry.parameters.clear();
  for (const ShapeParameter& p : chosen.parameters) geometry.parameters[p.name] = p.value;
  object("parameters", [&] {
    for (const ShapeParameter& p : chosen.parameters)
      number(p.name, geometry.parameters[p.name], p.low, p.high);
  });
}

void SpecReader::check_ends(const Json& j, const std::string& place) const {
  check_list(j, place);
  if (j.size() != 2)
    fail(place, concat("expected two values, of the first frame and of the end, found ", j.size()));
}

void SpecReader::ends(const char* name, std::vector<glm::dvec3>& value, double low, double high) {
  const Json* j = take(name);
  if (!j) return;
  const std::string place = path(name);
  check_ends(*j, place);
  value.clear();
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string at = place + "[" + std::to_string(i) + "]";
    const std::vector<double> numbers = number_list((*j)[i], at, low, high);
    if (numbers.size() != 3) fail(at, concat("expected 3 numbers, found ", numbers.size()));
    value.emplace_back(numbers[0], numbers[1], numbers[2]);
  }
}

void SpecReader::motion(const GeometrySpec& geometry, MotionSpec& motion) {
  const Shape* shape = find_shape(geometry.shape);  // a mesh file has no parameters
  object("motion", [&] {
    for (const ShapeParameter& p : shape ? shape->parameters : std::vector<ShapeParameter>()) {
      const Json* j = take(p.name);
      if (!j) continue;
      check_ends(*j, path(p.name));
      const std::vector<double> both = number_list(*j, path(p.name), p.low, p.high);
      motion.parameters[p.name] = {both[0], both[1]};
    }
    ends("rotate", motion.rotate, -kFullTurn, kFullTurn);
    ends("translate", motion.translate, -kFarthest, kFarthest);
  });
}

void SpecReader::finish() const {
  for (const auto& [name, value] : object_->items()) {
    if (known_.count(name)) continue;
    const std::vector<std::string> known(known_.begin(), known_.end());
    const auto near = nearest_name(name, known);
    fail(path(name), "there is no such field" +
                         (near ? "; did you mean " + *near + "?" : "; known are " + joined(known)));
  }
}

}  // namespace photohull::synth
