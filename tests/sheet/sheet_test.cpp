#include "sheet/sheet.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
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

SheetOptions rim_of(double diameter, double tag = 0) {
  SheetOptions options;
  options.kind = SheetKind::kRim;
  options.diameter = diameter, options.tag = tag;
  return options;
}

TEST(Sheet, AStripGoesOnceAroundTheCylinder) {
  for (const SheetOptions& flat : all_sheets())
    for (const SheetTag& tag : make_sheet(flat).tags) EXPECT_LT(tag.id, 300);
  for (const double diameter : {80.0, 200.0, 350.0}) {
    const Sheet s = make_sheet(rim_of(diameter));
    SCOPED_TRACE(diameter);
    const double around = s.pieces.back().to, pitch = around / double(s.tags.size());
    EXPECT_NEAR(around, std::numbers::pi * diameter, 0.5);
    EXPECT_GE(s.tags.size(), 30u);
    std::set<int> ids;
    for (std::size_t i = 0; i < s.tags.size(); ++i) {
      const SheetTag& tag = s.tags[i];
      EXPECT_GE(tag.id, 300);
      EXPECT_TRUE(ids.insert(tag.id).second);
      const SheetTag& next = s.tags[(i + 1) % s.tags.size()];
      EXPECT_NEAR(std::fmod(next.corners[0].x - tag.corners[0].x + around, around), pitch, 1e-9);
      EXPECT_NEAR(s.at(tag.corners[3]).z, 0.25 * (tag.corners[1].x - tag.corners[0].x), 1e-9);
      int pieces = 0;
      for (const StripPiece& piece : s.pieces)
        pieces += tag.corners[0].x > piece.from && tag.corners[1].x < piece.to;
      EXPECT_EQ(pieces, 1);
      for (const glm::dvec2& corner : tag.corners) {
        const glm::dvec3 p = s.at(corner);
        EXPECT_NEAR(std::hypot(p.x, p.y), 0.5 * diameter + 0.1, 1e-9);
        EXPECT_NEAR(glm::length(s.on_paper(p) - corner), 0, 1e-9);
      }
    }
    // The end meets the beginning.
    EXPECT_NEAR(glm::length(s.at({around, 0}) - s.at({0, 0})), 0, 1e-9);
    for (const StripPiece& piece : s.pieces) {
      EXPECT_GE(piece.low.x, 5);
      EXPECT_LE(piece.low.x + piece.to - piece.from + 8, s.page.x - 5);
      EXPECT_GT(piece.low.y, s.bar_from.y + 3);
      EXPECT_LE(piece.low.y + s.strip, s.page.y - 5);
    }
  }
}

TEST(Sheet, AStripIsRefusedWhereItCannotBe) {
  const auto message = [](const SheetOptions& options) {
    try {
      make_sheet(options);
    } catch (const UsageError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(rim_of(0)), HasSubstr("kind=rim: say how large the cylinder is: diameter"));
  EXPECT_THAT(message(rim_of(100, 20)), HasSubstr("an eighth of the diameter"));
  EXPECT_THAT(message(rim_of(20)), HasSubstr("tags of 3 mm around a cylinder of 20 mm"));
  EXPECT_THAT(message(rim_of(2000)), HasSubstr("does not fit on one page"));
  SheetOptions flat;
  flat.diameter = 100;
  EXPECT_THAT(message(flat), HasSubstr("diameter=100 is for a strip around a cylinder"));
}

TEST(Sheet, AStripIsDrawnInPiecesAndReadBack) {
  const ScratchFolder folder;
  const Sheet s = make_sheet(rim_of(200));
  const SheetPicture picture = sheet_picture(s, 20);
  for (const SheetTag& tag : s.tags) {
    const auto piece = std::ranges::find_if(
        s.pieces, [&](const StripPiece& p) { return tag.corners[0].x < p.to; });
    const auto cells = tag_cells(s.dictionary, tag.id);
    for (std::size_t y = 0; y < 8; ++y)
      for (std::size_t x = 0; x < 8; ++x) {
        const auto& c = tag.corners;
        const glm::dvec2 place = c[0] + (c[1] - c[0]) * ((double(x) + 0.5) / 8) +
                                 (c[3] - c[0]) * ((double(y) + 0.5) / 8);
        ASSERT_NEAR(picture.at(piece->low + place - glm::dvec2(piece->from, 0)),
                    cells[y][x] ? 1 : 0, 0.02);
      }
  }
  EXPECT_THAT(sheet_svg(s), HasSubstr("200 mm"));
  const std::string text = sheet_text(s);
  write_atomically(folder / "rim.json", text);
  const Sheet back = read_sheet(folder / "rim.json");
  EXPECT_EQ(back.diameter, 200);
  ASSERT_EQ(back.tags.size(), s.tags.size());
  for (std::size_t i = 0; i < s.tags.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_LT(glm::length(back.tags[i].corners[k] - s.tags[i].corners[k]), 1e-5);
  // A corner inside the cylinder.
  std::string damaged = text;
  damaged.replace(damaged.find("\"diameter\": 200"), 15, "\"diameter\": 210");
  write_atomically(folder / "rim.json", damaged);
  try {
    read_sheet(folder / "rim.json");
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(),
                HasSubstr("tags[0].corners[0]: expected a place on the cylinder's paper"));
  }
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
