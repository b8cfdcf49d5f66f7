#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/aruco/dictionary.hpp>
#include <set>

#include "core/error.h"
#include "core/json_levels.h"
#include "core/read_file.h"
#include "sheet/sheet.h"

namespace photohull {
namespace {

using nlohmann::ordered_json;
constexpr const char* kMark = "photohull_board";
constexpr double kLargest = 1e5;  // mm
constexpr std::size_t kMost = 10000;
constexpr double kOffCylinder = 0.01;  // mm

double rounded(double v) { return std::round(v * 1e6) / 1e6 + 0.0; }
ordered_json pair(const glm::dvec2& p) { return {rounded(p.x), rounded(p.y)}; }
ordered_json triple(const glm::dvec3& p) { return {rounded(p.x), rounded(p.y), rounded(p.z)}; }

/// Fields of a file, with messages that name them.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file.string()) {
    try {
      root_ = nlohmann::json::parse(read_whole_file(file), json_level_guard(file_));
    } catch (const nlohmann::json::exception& e) {
      throw Error(concat(file_, ": not valid JSON: ", e.what()));
    }
    if (!root_.is_object() || !root_.contains(kMark))
      throw Error(concat(file_, ": there is no field \"", kMark,
                         "\": expected the JSON file that was written beside the printed sheet"));
  }

  [[noreturn]] void fail(const std::string& field, const std::string& what) const {
    throw Error(concat(file_, ": ", field, ": ", what));
  }
  std::string text(const char* field) const {
    const auto& j = get(root_, field, field);
    if (!j.is_string()) fail(field, "expected a text in quotes, found " + shown(j));
    return j.get<std::string>();
  }
  glm::dvec2 point(const char* field) const { return point(get(root_, field, field), field); }
  glm::dvec2 point(const nlohmann::json& j, const std::string& field) const {
    if (!j.is_array() || j.size() != 2 || !j[0].is_number() || !j[1].is_number() ||
        !(std::abs(j[0].get<double>()) <= kLargest) || !(std::abs(j[1].get<double>()) <= kLargest))
      fail(field, "expected two lengths in millimetres [x, y], found " + shown(j));
    return {j[0].get<double>(), j[1].get<double>()};
  }
  template <std::size_t n>
  std::array<glm::dvec2, n> points(const nlohmann::json& j, const std::string& field) const {
    if (!j.is_array() || j.size() != n)
      fail(field, concat("expected ", n, " points, found ", shown(j)));
    std::array<glm::dvec2, n> all;
    for (std::size_t i = 0; i < n; ++i) all[i] = point(j[i], concat(field, "[", i, "]"));
    return all;
  }
  double length(const char* field) const {
    const auto& j = get(root_, field, field);
    if (!j.is_number() || !(j.get<double>() > 0 && j.get<double>() <= kLargest))
      fail(field, "expected a length above 0 in millimetres, found " + shown(j));
    return j.get<double>();
  }
  /// Corners on the strip around a cylinder, on its paper.
  std::array<glm::dvec2, 4> around(const nlohmann::json& j, const std::string& field,
                                   const Sheet& sheet) const {
    if (!j.is_array() || j.size() != 4) fail(field, "expected 4 points, found " + shown(j));
    std::array<glm::dvec2, 4> all;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!j[i].is_array() || j[i].size() != 3 ||
          !std::ranges::all_of(j[i], [](const auto& v) { return v.is_number(); }))
        fail(concat(field, "[", i, "]"),
             "expected three lengths in millimetres [x, y, z], found " + shown(j[i]));
      const glm::dvec3 p(j[i][0].get<double>(), j[i][1].get<double>(), j[i][2].get<double>());
      all[i] = sheet.on_paper(p);
      if (!(glm::length(sheet.at(all[i]) - p) < kOffCylinder))
        fail(concat(field, "[", i, "]"),
             concat("expected a place on the cylinder's paper, of a radius of ",
                    glm::length(glm::dvec2(sheet.at({0, 0}))), " mm, found ", shown(j[i])));
    }
    return all;
  }
  bool has(const char* field) const { return root_.contains(field); }
  const nlohmann::json& list(const char* field) const {
    const auto& j = get(root_, field, field);
    if (!j.is_array() || j.size() > kMost) fail(field, "expected a list, found " + shown(j));
    return j;
  }
  const nlohmann::json& get(const nlohmann::json& from, const char* name,
                            const std::string& field) const {
    if (!from.is_object() || !from.contains(name)) fail(field, "is missing");
    return from[name];
  }
  static std::string shown(const nlohmann::json& j) {
    const std::string text = j.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return text.size() > 60 ? text.substr(0, 57) + "..." : text;
  }

 private:
  std::string file_;
  nlohmann::json root_;
};

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

void read_tags(const Reader& r, Sheet& s) {
  int ids = 0;
  try {
    ids = cv::aruco::getPredefinedDictionary(tag_dictionary(s.dictionary))->bytesList.rows;
  } catch (const Error& e) {
    r.fail("dictionary", e.what());
  }
  std::set<int> seen;
  const auto& tags = r.list("tags");
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const std::string field = concat("tags[", i, "]");
    const auto& id = r.get(tags[i], "id", field + ".id");
    if (!id.is_number_integer() || id.get<std::int64_t>() < 0 || id.get<std::int64_t>() >= ids)
      r.fail(field + ".id",
             concat("expected a number from 0 to ", ids - 1, ", found ", Reader::shown(id)));
    if (!seen.insert(id.get<int>()).second)
      r.fail(field + ".id", concat("another tag has the number ", id.get<int>(), " already"));
    const auto& corners = r.get(tags[i], "corners", field + ".corners");
    SheetTag tag{id.get<int>(), s.is_flat() ? r.points<4>(corners, field + ".corners")
                                            : r.around(corners, field + ".corners", s)};
    if (!(cross(tag.corners[1] - tag.corners[0], tag.corners[2] - tag.corners[0]) < 0))
      r.fail(field + ".corners",
             "expected top left, top right, bottom right and bottom left with y upwards");
    s.tags.push_back(tag);
  }
  if (s.tags.empty()) r.fail("tags", "expected one tag at least, found none");
}

}  // namespace

std::string sheet_text(const Sheet& s) {
  ordered_json j;
  j[kMark] = 1;
  j["kind"] = s.kind;
  j["dictionary"] = s.dictionary;
  j["unit"] = "mm";
  j["page"] = pair(s.page);
  j["lower_left"] = pair(s.lower_left);
  j["free_min"] = pair(s.free_min);
  j["free_max"] = pair(s.free_max);
  j["bar_from"] = pair(s.bar_from);
  j["bar_to"] = pair(s.bar_to);
  j["bar_length"] = rounded(s.bar_length());
  if (!s.is_flat()) j["diameter"] = rounded(s.diameter), j["strip_height"] = rounded(s.strip);
  j["tags"] = ordered_json::array();
  for (const SheetTag& tag : s.tags) {
    ordered_json corners = ordered_json::array();
    for (const glm::dvec2& corner : tag.corners)
      corners.push_back(s.is_flat() ? pair(corner) : triple(s.at(corner)));
    j["tags"].push_back({{"id", tag.id}, {"corners", corners}});
  }
  j["squares"] = ordered_json::array();
  for (const auto& square : s.squares) j["squares"].push_back({pair(square[0]), pair(square[1])});
  j["saddles"] = ordered_json::array();
  for (const glm::dvec2& saddle : s.saddles) j["saddles"].push_back(pair(saddle));
  return j.dump(1) + "\n";
}

Sheet read_sheet(const std::filesystem::path& file) {
  const Reader r(file);
  Sheet s;
  s.kind = r.text("kind");
  s.dictionary = r.text("dictionary");
  if (const std::string unit = r.text("unit"); unit != "mm")
    r.fail("unit", "expected mm, found " + unit);
  s.page = r.point("page"), s.lower_left = r.point("lower_left");
  s.free_min = r.point("free_min"), s.free_max = r.point("free_max");
  s.bar_from = r.point("bar_from"), s.bar_to = r.point("bar_to");
  if (!(s.page.x > 0 && s.page.y > 0)) r.fail("page", "expected a width and a height above 0");
  if (!(s.free_max.x > s.free_min.x && s.free_max.y > s.free_min.y))
    r.fail("free_max", "expected a corner to the right of free_min and above it");
  if (r.has("diameter")) s.diameter = r.length("diameter"), s.strip = r.length("strip_height");
  read_tags(r, s);
  const auto& squares = r.list("squares");
  for (std::size_t i = 0; i < squares.size(); ++i)
    s.squares.push_back(r.points<2>(squares[i], concat("squares[", i, "]")));
  const auto& saddles = r.list("saddles");
  for (std::size_t i = 0; i < saddles.size(); ++i)
    s.saddles.push_back(r.point(saddles[i], concat("saddles[", i, "]")));
  return s;
}

}  // namespace photohull
