// Based on: E. Olson, "AprilTag: a robust and flexible visual fiducial system", 2011 [Olson11].
#include <algorithm>
#include <cmath>
#include <opencv2/aruco/dictionary.hpp>
#include <opencv2/core.hpp>

#include "core/error.h"
#include "core/nearest_name.h"
#include "core/option_word.h"
#include "sheet/sheet_parts.h"

namespace photohull {
namespace {

constexpr double kLeastFree = 20;    // mm along the free space's shorter side
constexpr double kLongestBar = 150;  // mm
constexpr double kTagInSquare = 0.75;
constexpr const char* kFamily = "apriltag-36h11";

struct Named {
  const char* name;
  int number;
};
constexpr Named kDictionaries[] = {
    {kFamily, cv::aruco::DICT_APRILTAG_36h11},  {"apriltag-25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"aruco-4x4-250", cv::aruco::DICT_4X4_250}, {"aruco-5x5-250", cv::aruco::DICT_5X5_250},
    {"aruco-6x6-250", cv::aruco::DICT_6X6_250},
};

glm::dvec2 size_of(Paper paper) {
  switch (paper) {
    case Paper::kA4:
      return {210, 297};
    case Paper::kA3:
      return {297, 420};
    case Paper::kLetter:
      return {215.9, 279.4};
  }
  return {};
}

double side_of(const SheetOptions& o) {
  if (o.tag > 0) return o.tag;
  return o.paper == Paper::kA3 ? 32 : 24;
}

/// Lower ends of so many sides as fit between two ends, evenly spread.
std::vector<double> spread(double first, double last, double side) {
  const double pitch = side * (1 + 2 * kQuiet);
  const int count = int(std::floor((last - first + side * 2 * kQuiet) / pitch + 1e-9));
  std::vector<double> places;
  for (int i = 0; i < count; ++i)
    places.push_back(first + (last - first - side) * i / std::max(1, count - 1));
  return places;
}

void add_ring(const SheetOptions& o, const glm::dvec2& low, const glm::dvec2& high, Sheet& sheet) {
  const double side = side_of(o), inward = side * (1 + 2 * kQuiet);
  const std::vector<double> across = spread(low.x, high.x, side), up = spread(low.y, high.y, side);
  int id = o.first_id;
  for (const double y : up)
    for (const double x : across)
      if (y == up.front() || y == up.back() || x == across.front() || x == across.back())
        sheet.tags.push_back(tag_at(id++, {x, y}, side));
  sheet.free_min = low + inward, sheet.free_max = high - inward;
}

void add_charuco(const SheetOptions& o, const glm::dvec2& low, const glm::dvec2& high,
                 Sheet& sheet) {
  constexpr int kWide = 2;  // squares
  const double side = side_of(o);
  const glm::ivec2 count((high - low) / side + 1e-9);
  const glm::dvec2 first = low + 0.5 * (high - low - side * glm::dvec2(count));
  const auto there = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < count.x && y < count.y &&
           (x < kWide || y < kWide || x >= count.x - kWide || y >= count.y - kWide);
  };
  int id = o.first_id;
  for (int y = 0; y < count.y; ++y)
    for (int x = 0; x < count.x; ++x) {
      if (!there(x, y)) continue;
      const glm::dvec2 at = first + side * glm::dvec2(x, y);
      if ((x + y) % 2 == 0)
        sheet.squares.push_back({at, at + side});
      else
        sheet.tags.push_back(
            tag_at(id++, at + 0.5 * (1 - kTagInSquare) * side, kTagInSquare * side));
      if (there(x - 1, y) && there(x, y - 1) && there(x - 1, y - 1)) sheet.saddles.push_back(at);
    }
  const double inward = (kWide + kQuiet) * side;
  sheet.free_min = first + inward, sheet.free_max = first + side * glm::dvec2(count) - inward;
}

/// So that the origin is the middle of the free space.
void move_origin(Sheet& s) {
  const glm::dvec2 middle = 0.5 * (s.free_min + s.free_max);
  for (SheetTag& tag : s.tags)
    for (glm::dvec2& corner : tag.corners) corner -= middle;
  for (auto& square : s.squares)
    for (glm::dvec2& corner : square) corner -= middle;
  for (glm::dvec2& saddle : s.saddles) saddle -= middle;
  for (glm::dvec2* p : {&s.lower_left, &s.free_min, &s.free_max, &s.bar_from, &s.bar_to})
    *p -= middle;
}

}  // namespace

SheetTag tag_at(int id, const glm::dvec2& low, double side) {
  const glm::dvec2 x(side, 0), y(0, side);
  return {id, {low + y, low + x + y, low + x, low}};
}

const char* to_string(Paper paper) {
  switch (paper) {
    case Paper::kA4:
      return "a4";
    case Paper::kA3:
      return "a3";
    case Paper::kLetter:
      return "letter";
  }
  return "?";
}

const char* to_string(SheetKind kind) {
  return kind == SheetKind::kRim       ? "rim"
         : kind == SheetKind::kCharuco ? "charuco"
                                       : "apriltag-ring";
}

void describe(Described& to, SheetOptions& o) {
  to.choice("paper", &o.paper, std::array{Paper::kA4, Paper::kA3, Paper::kLetter},
            "size of the page");
  to.choice("kind", &o.kind, std::array{SheetKind::kTagRing, SheetKind::kCharuco, SheetKind::kRim},
            "what is around the free space: tags, or a chessboard with tags in its white squares; "
            "or a strip of tags around the rim of a turntable or a pot");
  to.number("tag", &o.tag, from_to(0, 200), "mm", "side of a tag, or of a square of the chessboard")
      .zero = "by the paper: 24, and 32 on a3; of a rim a sixteenth of its diameter";
  to.number("first_id", &o.first_id, from_to(0, 586), "",
            "number of the first tag, so that two sheets can be told apart")
      .zero = "of a rim 300";
  to.number("diameter", &o.diameter, from_to(0, 5000), "mm",
            "diameter of the cylinder that a strip goes around")
      .zero = "no rim";
}

Sheet make_sheet(const SheetOptions& o) {
  check_options(o);
  if (o.kind != SheetKind::kRim && o.diameter > 0)
    throw UsageError(concat(option_word("diameter", o.diameter),
                            " is for a strip around a cylinder: ", "give ",
                            option_word("kind", "rim"), " with it"));
  Sheet s;
  s.kind = to_string(o.kind);
  s.dictionary = kFamily;
  s.page = size_of(o.paper);
  const glm::dvec2 low(kMargin, kMargin + kFooter), high = s.page - kMargin;
  if (o.kind == SheetKind::kRim)
    add_rim(o, s);
  else if (o.kind == SheetKind::kCharuco)
    add_charuco(o, low, high, s);
  else
    add_ring(o, low, high, s);
  if (s.is_flat() &&
      !(std::min(s.free_max.x - s.free_min.x, s.free_max.y - s.free_min.y) >= kLeastFree))
    throw UsageError(concat(option_word("tag"), ": sides of ", side_of(o),
                            " mm leave no free space of ", kLeastFree, " mm on ",
                            to_string(o.paper), " paper; use smaller ones or a larger paper"));
  const int ids = cv::aruco::getPredefinedDictionary(tag_dictionary(kFamily))->bytesList.rows;
  if (s.tags.back().id >= ids)
    throw UsageError(concat(option_word("first_id"), ": the sheet's ", s.tags.size(),
                            " tags would end at number ", s.tags.back().id,
                            ", and the last one is ", ids - 1, "; begin lower"));
  s.bar_from = {kMargin, kMargin + 3};
  s.bar_to = s.bar_from + glm::dvec2(kLongestBar, 0);
  if (s.is_flat()) move_origin(s);
  return s;
}

std::vector<std::string> tag_dictionaries() {
  std::vector<std::string> names;
  for (const Named& d : kDictionaries) names.emplace_back(d.name);
  return names;
}

int tag_dictionary(const std::string& name) {
  for (const Named& d : kDictionaries)
    if (name == d.name) return d.number;
  std::string known;
  for (const Named& d : kDictionaries) known += concat(known.empty() ? "" : ", ", d.name);
  throw Error(concat("there is no dictionary of tags called \"", name, "\"; known are ", known));
}

std::vector<std::vector<bool>> tag_cells(const std::string& dictionary, int id) {
  const auto tags = cv::aruco::getPredefinedDictionary(tag_dictionary(dictionary));
  PHOTOHULL_CHECK(id >= 0 && id < tags->bytesList.rows);
  const int side = tags->markerSize + 2;
  cv::Mat picture;
  tags->drawMarker(id, side, picture, 1);
  std::vector<std::vector<bool>> cells(static_cast<std::size_t>(side));
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      cells[std::size_t(y)].push_back(picture.at<std::uint8_t>(y, x) > 127);
  return cells;
}

}  // namespace photohull
