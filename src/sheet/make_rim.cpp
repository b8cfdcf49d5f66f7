#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/option_word.h"
#include "sheet/sheet_parts.h"

namespace photohull {
namespace {

constexpr double kPaperThick = 0.1;      // mm, the strip's thickness
constexpr double kUsualTag = 1 / 16.0;   // of the diameter
constexpr double kLargestTag = 1 / 8.0;  // edges are taken for straight, and are arcs
constexpr double kSmallestTag = 3;       // mm
constexpr double kMostUsual = 24;        // mm
constexpr double kStripHeight = 1.5;     // tags' sides
constexpr double kBetween = 5;           // mm between the pieces on the page
constexpr int kFirstOfRim = 300;         // above the numbers of the other kinds
constexpr double kMostBar = 2;           // times as long as stated, or as short

/// Of the middle of the paper, which is as long wrapped as it was flat.
double neutral_radius(const Sheet& s) { return 0.5 * (s.diameter + kPaperThick); }
double outer_radius(const Sheet& s) { return 0.5 * s.diameter + kPaperThick; }

double rim_side(const SheetOptions& o) {
  const double usual = std::clamp(kUsualTag * o.diameter, kSmallestTag, kMostUsual);
  const double side = o.tag > 0 ? o.tag : usual;
  if (side < kSmallestTag || side > kLargestTag * o.diameter * (1 + 1e-9))
    throw UsageError(concat(
        "tags of ", side, " mm around a cylinder of ", o.diameter, " mm: they must be from ",
        kSmallestTag,
        " mm to an eighth of the diameter, for they are taken for nearly flat; give another ",
        option_word("tag"), " or ", option_word("diameter")));
  return side;
}

/// Pieces of whole tags, below each other.
void lay_out(double pitch, std::size_t tags, Sheet& s) {
  const double usable = s.page.x - 2 * kMargin - kGlued;
  const auto most = std::size_t(std::max(0.0, std::floor(usable / pitch)));
  const double line = s.strip + kBetween;
  const auto lines =
      std::size_t(std::max(0.0, std::floor((s.page.y - 2 * kMargin - kFooter + kBetween) / line)));
  if (most == 0 || (tags + most - 1) / most > lines)
    throw UsageError(concat(option_word("diameter", s.diameter), ": the strip of ",
                            std::round(double(tags) * pitch), " mm does not fit on one page of ",
                            s.page.x, " x ", s.page.y, " mm; give a larger ", option_word("paper"),
                            " or a smaller ", option_word("tag")));
  for (std::size_t first = 0; first < tags; first += most) {
    const double y = s.page.y - kMargin - line * double(s.pieces.size() + 1) + kBetween;
    s.pieces.push_back(
        {pitch * double(first), pitch * double(std::min(tags, first + most)), {kMargin, y}});
  }
}

}  // namespace

void add_rim(const SheetOptions& o, Sheet& s) {
  if (!(o.diameter > 0))
    throw UsageError(concat(option_word("kind", "rim"), ": say how large the cylinder is: ",
                            option_word("diameter"), " with its outer diameter in millimetres"));
  s.diameter = o.diameter;
  const double side = rim_side(o), around = 2 * M_PI * neutral_radius(s);
  const auto tags = std::size_t(std::floor(around / (side * (1 + 2 * kQuiet))));
  const double pitch = around / double(tags);
  s.strip = kStripHeight * side;
  const int first = o.first_id > 0 ? o.first_id : kFirstOfRim;
  for (std::size_t i = 0; i < tags; ++i)
    s.tags.push_back(tag_at(
        first + int(i), {(double(i) + 0.5) * pitch - 0.5 * side, 0.5 * (s.strip - side)}, side));
  s.free_min = glm::dvec2(-0.5 * s.diameter), s.free_max = glm::dvec2(0.5 * s.diameter);
  lay_out(pitch, tags, s);
}

glm::dvec3 Sheet::at(const glm::dvec2& p) const {
  if (is_flat()) return {p, 0};
  const double angle = p.x / neutral_radius(*this), r = outer_radius(*this);
  return {r * std::cos(angle), r * std::sin(angle), p.y};
}

glm::dvec2 Sheet::on_paper(const glm::dvec3& p) const {
  if (is_flat()) return {p.x, p.y};
  const double angle = std::atan2(p.y, p.x);
  return {neutral_radius(*this) * (angle < -1e-9 ? angle + 2 * M_PI : angle), p.z};
}

void check_bar(const Sheet& sheet, double measured) {
  const double bar = sheet.bar_length();
  if (measured > 0 && !(measured < kMostBar * bar && measured > bar / kMostBar))
    throw UsageError(concat(option_word("bar", measured), ": the board's bar is ", bar,
                            " mm long at 100 %; give its printed length in millimetres"));
}

Sheet as_printed(const Sheet& sheet, double bar) {
  check_bar(sheet, bar);
  Sheet s = sheet;
  if (s.is_flat() || !(bar > 0)) return s;
  const double print = bar / s.bar_length();
  for (SheetTag& tag : s.tags)
    for (glm::dvec2& corner : tag.corners) corner *= print;
  s.bar_from *= print, s.bar_to *= print, s.strip *= print;
  return s;
}

}  // namespace photohull
