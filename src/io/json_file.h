// JSON files of scenes, with errors that name the file and the field. Internal to io.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace photohull::io {

/// The whole file. Throws Error when it is no JSON, or deeper or larger than a scene can be.
nlohmann::json parse_json(const std::filesystem::path& file);

/// A value and its place in the file ("FILE views[3].path"), which opens every error message.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, std::string where)
      : value_(&value), where_(std::move(where)) {}

  const std::string& where() const { return where_; }
  const nlohmann::json& json() const { return *value_; }

  /// A field that may be missing or null.
  std::optional<JsonNode> find(const char* key) const;
  /// A field that must be there; throws Error.
  JsonNode operator[](const char* key) const;
  /// Elements of an array; size() throws Error for anything else, at() for a missing element.
  std::size_t size() const;
  JsonNode at(std::size_t index) const;

  /// A finite number, also where it is written as a string (as Boost's property trees do).
  double number() const;
  double number(const char* key, double fallback) const;
  std::string text() const;
  std::string text(const char* key, const std::string& fallback) const;
  /// A whole number from 1 to 10^9: sizes are often written as 640.0.
  int size_in_pixels() const;
  /// A string, or a number as text: identifiers are written either way.
  std::string identifier() const;

 private:
  const nlohmann::json* value_;
  std::string where_;
};

}  // namespace photohull::io
