#include "lab/chart/json_fields.h"

#include <algorithm>

#include "core/error.h"
#include "core/json_levels.h"
#include "core/nearest_name.h"
#include "core/read_file.h"

namespace photohull::chart {
namespace {

std::string found_text(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 40) text = text.substr(0, 37) + "...";
  return text;
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::size_t limit) {
  std::error_code status;
  if (!std::filesystem::is_regular_file(path, status))
    throw Error(concat(path.string(), ": there is no such file"));
  if (std::filesystem::file_size(path, status) > limit)
    throw Error(concat(path.string(), ": larger than ", limit >> 20, " MiB"));
  return read_whole_file(path);
}

Json read_json(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  try {
    return Json::parse(text, json_level_guard(path.string()));
  } catch (const Json::exception& e) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
    std::string what = e.what();
    if (const std::size_t at = what.find("] "); at != std::string::npos) what.erase(0, at + 2);
    throw Error(concat(path.string(), ": not valid JSON: ", what));
  }
}

Fields::Fields(const std::filesystem::path& file, std::string where, const Json& object)
    : file_(file), where_(std::move(where)), object_(object) {
  if (!object.is_object())
    throw Error(concat(file_.string(), ": ", where_.empty() ? "the file" : where_,
                       ": expected an object, found ", found_text(object)));
}

std::string Fields::path(const std::string& name) const {
  return where_.empty() ? name : where_ + "." + name;
}

void Fields::fail(const std::string& name, const std::string& what) const {
  throw Error(concat(file_.string(), ": ", path(name), ": ", what));
}

void Fields::allow_only(const std::vector<std::string>& names) const {
  for (const auto& [name, value] : object_.items()) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    std::string known;
    for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
    const auto near = nearest_name(name, names);
    fail(name, near ? "unknown field; did you mean '" + *near + "'?"
                    : "unknown field; expected one of " + known);
  }
}

void Fields::require_layout(int layout) const {
  if (const Json& found = at("layout"); found != layout)
    fail("layout", concat("written by another version of photohull (", found.dump(), " instead of ",
                          layout, ")"));
}

const Json& Fields::at(const std::string& name) const {
  if (!has(name)) fail(name, "is missing");
  return object_.at(name);
}

std::string Fields::text(const std::string& name) const {
  const Json& value = at(name);
  if (!value.is_string() || value.get_ref<const std::string&>().empty())
    fail(name, "expected a text, found " + found_text(value));
  return value.get<std::string>();
}

bool Fields::flag(const std::string& name, bool otherwise) const {
  if (!has(name)) return otherwise;
  if (!at(name).is_boolean()) fail(name, "expected true or false, found " + found_text(at(name)));
  return at(name).get<bool>();
}

double Fields::number(const std::string& name, double least, double greatest) const {
  const Json& value = at(name);
  if (!value.is_number() || !(value.get<double>() >= least && value.get<double>() <= greatest))
    fail(name,
         concat("expected a number from ", least, " to ", greatest, ", found ", found_text(value)));
  return value.get<double>();
}

int Fields::integer(const std::string& name, int least, int greatest) const {
  const Json& value = at(name);
  if (!value.is_number_integer() || value.get<double>() < least || value.get<double>() > greatest)
    fail(name, concat("expected a whole number from ", least, " to ", greatest, ", found ",
                      found_text(value)));
  return value.get<int>();
}

std::vector<std::pair<std::string, const Json*>> Fields::elements(const std::string& name) const {
  std::vector<std::pair<std::string, const Json*>> found;
  if (!has(name)) return found;
  const Json& value = at(name);
  if (!value.is_array()) fail(name, "expected an array, found " + found_text(value));
  for (std::size_t i = 0; i < value.size(); ++i)
    found.emplace_back(concat(name, "[", i, "]"), &value[i]);
  return found;
}

std::vector<std::string> Fields::texts(const std::string& name) const {
  std::vector<std::string> found;
  for (const auto& [element, value] : elements(name)) {
    if (!value->is_string() || value->get_ref<const std::string&>().empty())
      fail(element, "expected a text, found " + found_text(*value));
    found.push_back(value->get<std::string>());
  }
  return found;
}

std::vector<int> Fields::integers(const std::string& name, int least, int greatest) const {
  std::vector<int> found;
  for (const auto& [element, value] : elements(name)) {
    if (!value->is_number_integer() || value->get<double>() < least ||
        value->get<double>() > greatest)
      fail(element, concat("expected a whole number from ", least, " to ", greatest, ", found ",
                           found_text(*value)));
    found.push_back(value->get<int>());
  }
  return found;
}

}  // namespace photohull::chart
