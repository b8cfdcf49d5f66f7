// Objects of a JSON file, read field by field with errors that name file and field. Private to
// lab.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace photohull::chart {

using Json = nlohmann::ordered_json;

/// The whole of a text file; throws Error when it cannot be read or is larger than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t limit = 256u << 20);
/// A file parsed as JSON; throws Error with the file, line and column of what is wrong.
Json read_json(const std::filesystem::path& path);

/// One object. Every function throws Error("FILE: PATH: ...") for a wrong type or range.
class Fields {
 public:
  /// `where` is the object's JSON path, such as "scenes[2]"; empty for the file's root.
  Fields(const std::filesystem::path& file, std::string where, const Json& object);

  /// Refuses fields other than these, naming the nearest one.
  void allow_only(const std::vector<std::string>& names) const;
  /// Refuses a field "layout" other than this number, which counts versions of what is written.
  void require_layout(int layout) const;
  bool has(const std::string& name) const { return object_.contains(name); }
  const Json& at(const std::string& name) const;

  std::string text(const std::string& name) const;
  bool flag(const std::string& name, bool otherwise) const;
  double number(const std::string& name, double least, double greatest) const;
  int integer(const std::string& name, int least, int greatest) const;
  /// Elements of an array, with their paths; none when the field is absent.
  std::vector<std::pair<std::string, const Json*>> elements(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;
  std::vector<int> integers(const std::string& name, int least, int greatest) const;

  std::string path(const std::string& name) const;
  [[noreturn]] void fail(const std::string& name, const std::string& what) const;

 private:
  const std::filesystem::path& file_;
  std::string where_;
  const Json& object_;
};

}  // namespace photohull::chart
