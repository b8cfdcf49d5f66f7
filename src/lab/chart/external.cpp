#include "lab/chart/external.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "core/error.h"
#include "core/nearest_name.h"
#include "lab/chart/names.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kColumns = {"scene",     "tool",    "resolution", "cpu_s",
                                           "wall_s",    "peak_mb", "acc90_pct",  "comp05",
                                           "triangles", "failed",  "f025"};

/// 0.25 of "f025": the first digit is the percents', the others are decimals.
std::optional<double> threshold_of(const std::string& column) {
  if (column.size() < 2 || column.size() > 8 || column[0] != 'f' ||
      column.find_first_not_of("0123456789", 1) != std::string::npos)
    return std::nullopt;
  const double value = std::atof((column.substr(1, 1) + "." + column.substr(2)).c_str());
  return value > 0 ? std::optional(value) : std::nullopt;
}

class Row {
 public:
  Row(const fs::path& file, const std::string& where, const Json& json)
      : fields_(file, where, json), json_(json) {}

  Outcome read() const {
    Outcome o;
    o.external = true;
    o.scene = fields_.text("scene");
    o.variant = fields_.text("tool");
    for (const std::string name : {"scene", "tool"})
      if (const auto fault = label_fault(fields_.text(name))) fields_.fail(name, *fault);
    for (const auto& [name, value] : json_.items()) {
      const auto threshold = threshold_of(name);
      if (!threshold && std::find(kColumns.begin(), kColumns.end(), name) == kColumns.end()) {
        const auto near = nearest_name(name, kColumns);
        fields_.fail(name,
                     near ? "unknown column; did you mean '" + *near + "'?" : "unknown column");
      }
      if (const auto f = threshold ? number(name, 0, 100) : std::nullopt)
        o.figures.f_percent[*threshold] = *f;
    }
    if (given("resolution")) o.resolution = int(*number("resolution", 1, 1e6));
    o.cpu_seconds = number("cpu_s", 0, 1e12);
    o.wall_seconds = number("wall_s", 0, 1e12);
    o.peak_mb = number("peak_mb", 0, 1e12);
    o.figures.accuracy_percent = number("acc90_pct", 0, 1e12);
    o.figures.completeness_percent = number("comp05", 0, 100);
    if (const auto n = number("triangles", 0, 1e15)) o.figures.triangles = std::int64_t(*n);
    o.failed = given("failed") && fields_.flag("failed", false);
    if (o.failed) o.failure = "said to have failed by its table";
    return o;
  }

 private:
  bool given(const std::string& name) const {
    return fields_.has(name) && !fields_.at(name).is_null();
  }
  std::optional<double> number(const std::string& name, double least, double greatest) const {
    return given(name) ? std::optional(fields_.number(name, least, greatest)) : std::nullopt;
  }

  Fields fields_;
  const Json& json_;
};

/// Fields of CSV text (RFC 4180): quotes may hold commas, line ends and doubled quotes.
std::vector<std::vector<std::string>> parse_csv(const fs::path& file, const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    std::string& field = rows.back().back();
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      field += c;
      ++i;
    } else if (c == '"' && (quoted || field.empty())) {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\n') {
      rows.emplace_back(1);
    } else if (quoted || c != '\r') {
      field += c;
    }
  }
  if (quoted) throw Error(concat(file.string(), ": a quotation mark is not closed"));
  std::erase_if(rows, [](const auto& row) { return row.size() == 1 && row[0].empty(); });
  return rows;
}

/// A CSV field as JSON would say it.
Json value_of(const std::string& column, const std::string& text) {
  if (text.empty()) return nullptr;
  if (column == "scene" || column == "tool") return text;
  if (text == "true" || text == "false") return text == "true";
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (*end == '\0' && std::isfinite(number)) return number;
  return text;  // refused by its reader, with the text shown
}

Json csv_as_json(const fs::path& file) {
  std::string text = read_file(file);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  const auto rows = parse_csv(file, text);
  if (rows.empty()) throw Error(concat(file.string(), ": empty; a header line is needed"));
  Json array = Json::array();
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r].size() != rows[0].size())
      throw Error(concat(file.string(), ": row ", r, " has ", rows[r].size(),
                         " fields, the header ", rows[0].size()));
    Json object = Json::object();
    for (std::size_t c = 0; c < rows[r].size(); ++c)
      object[rows[0][c]] = value_of(rows[0][c], rows[r][c]);
    array.push_back(std::move(object));
  }
  return array;
}

}  // namespace

std::vector<Outcome> read_external(const fs::path& file) {
  const Json rows = file.extension() == ".csv" ? csv_as_json(file) : read_json(file);
  if (!rows.is_array())
    throw Error(concat(file.string(), ": expected an array of objects, one a result"));
  std::vector<Outcome> outcomes;
  std::set<std::pair<std::string, std::string>> seen;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string where =
        file.extension() == ".csv" ? concat("row ", i + 1) : concat("[", i, "]");
    outcomes.push_back(Row(file, where, rows[i]).read());
    if (!seen.emplace(outcomes.back().scene, outcomes.back().label()).second)
      throw Error(concat(file.string(), ": ", where, ": ", outcomes.back().label(), " on ",
                         outcomes.back().scene, " is there twice"));
  }
  return outcomes;
}

}  // namespace photohull::chart
