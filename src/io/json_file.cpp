#include "io/json_file.h"

#include <cmath>

#include "core/error.h"
#include "io/text_file.h"

namespace photohull::io {
namespace {

using nlohmann::json;

/// A frame takes about 40 values; this is enough for half a million and keeps a hostile file from
/// growing to many times its size in memory.
constexpr std::size_t kMaxValues = 20'000'000;
constexpr int kMaxDepth = 32;

}  // namespace

json parse_json(const std::filesystem::path& file) {
  const std::string text = read_text_file(file);
  if (trimmed(text).empty())
    throw Error(concat(file.string(), ": the file is empty; copy or export it again"));
  std::size_t values = 0;
  const auto guard = [&](int depth, json::parse_event_t, json&) {
    if (depth > kMaxDepth || ++values > kMaxValues)
      throw Error(concat(file.string(), ": more than ", kMaxDepth, " levels or ", kMaxValues,
                         " values are no scene; check that this is the right file"));
    return true;
  };
  try {
    return json::parse(text, guard);
  } catch (const json::exception& failure) {
    throw Error(concat(file.string(), ": not valid JSON (", failure.what(),
                       "); NaN, comments and trailing commas are not allowed"));
  }
}

std::optional<JsonNode> JsonNode::find(const char* key) const {
  if (!value_->is_object()) throw Error(where_ + ": must be an object");
  const auto found = value_->find(key);
  if (found == value_->end() || found->is_null()) return std::nullopt;
  return JsonNode(*found, concat(where_, " ", key));
}

JsonNode JsonNode::operator[](const char* key) const {
  if (auto found = find(key)) return *found;
  throw Error(concat(where_, ": ", key, " is missing"));
}

std::size_t JsonNode::size() const {
  if (!value_->is_array()) throw Error(where_ + ": must be an array");
  return value_->size();
}

JsonNode JsonNode::at(std::size_t index) const {
  if (index >= size())
    throw Error(
        concat(where_, ": has ", size(), " elements, but more than ", index, " are needed"));
  return {(*value_)[index], concat(where_, "[", index, "]")};
}

double JsonNode::number() const {
  std::optional<double> value;
  if (value_->is_number()) value = value_->get<double>();
  if (value_->is_string()) value = parse_double(trimmed(value_->get_ref<const std::string&>()));
  if (!value || !std::isfinite(*value)) throw Error(where_ + ": must be a finite number");
  return *value;
}

double JsonNode::number(const char* key, double fallback) const {
  const auto found = find(key);
  return found ? found->number() : fallback;
}

std::string JsonNode::text() const {
  if (!value_->is_string()) throw Error(where_ + ": must be a string");
  return value_->get<std::string>();
}

std::string JsonNode::text(const char* key, const std::string& fallback) const {
  const auto found = find(key);
  return found ? found->text() : fallback;
}

int JsonNode::size_in_pixels() const {
  const double value = number();
  if (!(value >= 1) || value != std::floor(value) || value > 1e9)
    throw Error(
        concat(where_, ": is ", value, ", but a whole positive number of pixels is needed"));
  return int(value);
}

std::string JsonNode::identifier() const {
  if (value_->is_string()) return value_->get<std::string>();
  if (value_->is_number_integer()) return value_->dump();
  throw Error(where_ + ": must be a whole number or a string");
}

}  // namespace photohull::io
