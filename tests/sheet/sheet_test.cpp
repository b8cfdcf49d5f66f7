#include "sheet/sheet.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/atomic_file.h"
#include "core/error.h"
#include "sheet/bend_sheet.h"
#include "sheet/draw_sheet.h"
#include "sheet/meet_sheet.h"
#include "support/scratch_folder.h"

namespace photohull {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::vector<SheetOptions> all_sheets() {
  std::vector<SheetOptions> all;
  for (const Paper paper : {Paper::kA4, Paper::kA3, Paper::kLetter})
    for (const SheetKind kind : {SheetKind::kTagRing, SheetKind::kCharuco})
      all.push_back({paper, kind});
  return all;
}

/// The rectangle that corners span.
template <typename Corners>
std::array<glm::dvec2, 2> bounds(const Corners& corners) {
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (const glm::dvec2& c : corners) low = glm::min(low, c), high = glm::max(high, c);
  return {low, high};
}

bool overlap(const std::array<glm::dvec2, 2>& a, const std::array<glm::dvec2, 2>& b, double rim) {
  return a[0].x < b[1].x + rim && b[0].x < a[1].x + rim && a[0].y < b[1].y + rim &&
         b[0].y < a[1].y + rim;
}

TEST(Sheet, TagsHaveRoomOnThePageAndAroundTheObject) {
  for (const SheetOptions& options : all_sheets()) {
    const Sheet s = make_sheet(options);
    SCOPED_TRACE(concat(to_string(options.paper), " ", s.kind));
    EXPECT_GE(s.tags.size(), 16u);
    EXPECT_GT(std::min(s.free_max.x - s.free_min.x, s.free_max.y - s.free_min.y), 80);
    EXPECT_NEAR(glm::length(s.free_min + s.free_max), 0, 1e-9);
    std::set<int> ids;
    for (std::size_t i = 0; i < s.tags.size(); ++i) {
      EXPECT_TRUE(ids.insert(s.tags[i].id).second);
      const auto box = bounds(s.tags[i].corners);
      const double quiet = (box[1].x - box[0].x) / 8;
      for (int c = 0; c < 2; ++c) {
        EXPECT_GE(box[0][c], s.lower_left[c] + 5);  // what printers leave free
        EXPECT_LE(box[1][c], s.lower_left[c] + s.page[c] - 5);
      }
      EXPECT_FALSE(overlap(box, {s.free_min, s.free_max}, quiet - 1e-9));
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_FALSE(overlap(box, bounds(s.tags[k].corners), 2 * quiet - 1e-9));
      for (const auto& square : s.squares) EXPECT_FALSE(overlap(box, square, quiet - 1e-9));
      EXPECT_FALSE(overlap(box, bounds(std::array{s.bar_from, s.bar_to}), 2));
    }
    EXPECT_EQ(s.saddles.empty(), options.kind == SheetKind::kTagRing);
  }
}

TEST(Sheet, IsRefusedWhereItCannotBe) {
  EXPECT_THROW(make_sheet({Paper::kA4, SheetKind::kTagRing, 80}), UsageError);
  EXPECT_THROW(make_sheet({Paper::kA4, SheetKind::kTagRing, 0, 580}), UsageError);
  EXPECT_NO_THROW(make_sheet({Paper::kA4, SheetKind::kTagRing, 0, 550}));
}

TEST(Sheet, FileIsReadBack) {
  const ScratchFolder folder;
  for (const SheetOptions& options : all_sheets()) {
    const Sheet s = make_sheet(options);
    write_atomically(folder / "board.json", sheet_text(s));
    const Sheet back = read_sheet(folder / "board.json");
    EXPECT_EQ(sheet_text(back), sheet_text(s));
    EXPECT_NEAR(back.bar_length(), 150, 1e-5);
  }
}

TEST(Sheet, DamagedFilesAreNamedWithTheField) {
  const ScratchFolder folder;
  const std::string good = sheet_text(make_sheet({}));
  const auto message = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    write_atomically(folder / "board.json", text);
    try {
      read_sheet(folder / "board.json");
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message("\"id\": 1,", "\"id\": 0,"), HasSubstr("tags[1].id: another tag"));
  EXPECT_THAT(message("\"id\": 1,", "\"id\": 587,"), HasSubstr("from 0 to 586, found 587"));
  EXPECT_THAT(message("\"mm\"", "\"inch\""), HasSubstr("unit: expected mm"));
  EXPECT_THAT(message("apriltag-36h11", "apriltag-0"), HasSubstr("known are apriltag-36h11"));
  EXPECT_THAT(message("\"free_min\"", "\"free\""), HasSubstr("free_min: is missing"));
  EXPECT_THAT(message("photohull_board", "board"), HasSubstr("photohull_board"));
  EXPECT_THAT(message("{", "["), HasSubstr("not valid JSON"));
}

/// Every cell of every tag, by its middle and near its corners.
TEST(Sheet, PictureShowsTheTags) {
  for (const SheetOptions& options : all_sheets()) {
    const Sheet s = make_sheet(options);
    const SheetPicture picture = sheet_picture(s, options.paper == Paper::kA3 ? 5 : 10);
    for (const SheetTag& tag : s.tags) {
      const auto cells = tag_cells(s.dictionary, tag.id);
      for (std::size_t y = 0; y < 8; ++y)
        for (std::size_t x = 0; x < 8; ++x)
          for (const double u : {0.1, 0.5, 0.9})
            for (const double v : {0.1, 0.5, 0.9}) {
              const auto& c = tag.corners;
              const glm::dvec2 place = c[0] + (c[1] - c[0]) * ((double(x) + u) / 8) +
                                       (c[3] - c[0]) * ((double(y) + v) / 8);
              ASSERT_NEAR(picture.at(place), cells[y][x] ? 1 : 0, 0.02);
            }
    }
    for (const auto& square : s.squares) EXPECT_LT(picture.at(0.5 * (square[0] + square[1])), 0.02);
    EXPECT_FLOAT_EQ(picture.at({0, 0}), 1);
    EXPECT_LT(picture.at(s.lower_left - 1.0), 0);
    EXPECT_LT(picture.at(0.5 * (s.bar_from + s.bar_to)), 0.6);
  }
}

TEST(Sheet, IsPrintedTheSameEveryTime) {
  const Sheet s = make_sheet({});
  const std::string pdf = sheet_pdf(s);
  EXPECT_THAT(pdf, StartsWith("%PDF"));
  EXPECT_EQ(pdf, sheet_pdf(s));
  EXPECT_THAT(sheet_svg(s), HasSubstr("width=\"210mm\" height=\"297mm\""));
  EXPECT_THAT(sheet_svg(s), HasSubstr("150 mm"));
}

/// A strip of a bent sheet is as long as it was flat, and rays find its places.
TEST(Sheet, BendsWithoutStretching) {
  const double reach = 180, bend[3] = {0, 0, 5 * 180.0 * 180.0 / (148.5 * 148.5)};
  double length = 0;
  glm::dvec3 before(0.0);
  for (int i = 1; i <= 1000; ++i) {
    glm::dvec3 p(0, 148.5 * i / 1000, 0);
    bend_sheet(bend, reach, &p.x);
    length += glm::length(p - before);
    before = p;
  }
  EXPECT_NEAR(before.z, 5, 1e-9);
  EXPECT_NEAR(length, 148.5, 1e-3);
  const glm::dvec3 eye(100, -200, 300);
  for (const glm::dvec2 place : {glm::dvec2(0, 0), glm::dvec2(90, 140), glm::dvec2(-80, -120)}) {
    glm::dvec3 p(place, 0);
    bend_sheet(bend, reach, &p.x);
    const auto hit = meet_sheet(eye, p - eye, {bend[0], bend[1], bend[2]}, reach);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 1, 1e-4);
    EXPECT_NEAR(glm::length(hit->place - place), 0, 0.02);
  }
  EXPECT_FALSE(meet_sheet(eye, {0, 0, 1}, glm::dvec3(0.0), reach));
}

}  // namespace
}  // namespace photohull
