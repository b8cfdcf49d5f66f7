// Lines of masks whose middle, direction and width are known.
#include "masks/mask_lines.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string>

#include "masks/drawn_masks.h"
#include "masks/silhouette.h"
#include "support/cameras.h"

namespace photohull {
namespace {

using glm::dvec2;
using test::Drawing;

constexpr int kSize = 64;
constexpr double kWidths[] = {0.15, 0.3, 0.5, 1, 1.5, 2};

/// A line through the whole frame.
struct Line {
  double width = 1;    ///< pixels
  double degrees = 0;  ///< between its direction and the x axis
  double offset = 0;   ///< pixels, of its middle from the frame's, across it

  dvec2 along() const {
    const double angle = degrees * std::numbers::pi / 180;
    return {std::cos(angle), std::sin(angle)};
  }
  dvec2 across() const { return {-along().y, along().x}; }
  dvec2 at(double t) const { return 0.5 * (kSize - 1) + t * along() + offset * across(); }
  void draw(Drawing& drawing) const { drawing.add_band(at(-kSize), at(kSize), width); }
  Mask mask() const {
    Drawing drawing(kSize, kSize);
    draw(drawing);
    return drawing.mask();
  }
  double distance(const LinePoint& p) const {
    return std::abs(glm::dot(dvec2(p.x, p.y) - at(0), across()));
  }
  /// Pixels within which a mask tells where the line is: while it runs within one row of pixels it
  /// could be anywhere in it.
  double knowable() const {
    const double slope = std::min(std::abs(along().x), std::abs(along().y));
    return slope < 0.1 ? std::max(0.15, 0.5 * (1 - width) + 0.005) : 0.15;
  }
  std::string name() const {
    return std::to_string(width) + " px at " + std::to_string(degrees) + " degrees, " +
           std::to_string(offset) + " px off";
  }
};

/// Calls f(line) for lines of all widths, at several angles and places between pixels.
void for_lines(const std::function<void(const Line&)>& f) {
  for (const double width : kWidths)
    for (const double degrees : {0.0, 3.0, 18.0, 30.0, 45.0, 63.0, 87.0, 90.0, 120.0, 157.0})
      for (const double offset : {-0.5, -0.25, 0.0, 0.1, 0.3}) f({width, degrees, offset});
}

bool far_from_frame(const dvec2& p, double by) {
  return p.x >= by && p.y >= by && p.x <= kSize - 1 - by && p.y <= kSize - 1 - by;
}

/// The line's own pixels along its steeper axis: how far from its middle is the nearest point?
double worst_gap(const Line& line, const std::vector<LinePoint>& points) {
  const int axis = std::abs(line.along().x) >= std::abs(line.along().y) ? 0 : 1;
  double worst = 0;
  for (int i = 0; i < kSize; ++i) {
    const double t = (i - line.at(0)[axis]) / line.along()[axis];
    if (!far_from_frame(line.at(t), 4)) continue;
    double nearest = 1e9;
    for (const LinePoint& p : points)
      if (std::abs((axis == 0 ? p.x : p.y) - i) <= 0.75)
        nearest = std::min(nearest, line.distance(p));
    worst = std::max(worst, nearest);
  }
  return worst;
}

double bilinear(const SilhouetteDistance& d, const dvec2& p) {
  const int x = int(std::floor(p.x)), y = int(std::floor(p.y));
  const auto at = [&](int i, int j) { return double(d.pixels[std::size_t(j * d.width + i)]); };
  const double u = p.x - x, v = p.y - y;
  return (1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) +
         v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
}

TEST(FindLines, HaveAPointBesideEveryPixelOfTheirMiddle) {
  for_lines([](const Line& line) {
    EXPECT_LT(worst_gap(line, find_lines(line.mask())), line.knowable()) << line.name();
  });
}

TEST(FindLines, SayWhereWhichWayAndHowWide) {
  for_lines([](const Line& line) {
    double sum = 0, off = 0, degrees = 0, worst = 0;
    int count = 0;
    for (const LinePoint& p : find_lines(line.mask())) {
      if (!far_from_frame({p.x, p.y}, 4)) continue;
      sum += p.width, ++count;
      off = std::max(off, line.distance(p));
      const double sine = std::abs(glm::dot(dvec2(p.normal_x, p.normal_y), line.along()));
      const double turned = std::asin(sine) * 180 / std::numbers::pi;
      degrees += turned, worst = std::max(worst, turned);
      EXPECT_NEAR(std::hypot(p.normal_x, p.normal_y), 1, 1e-5);
    }
    ASSERT_GT(count, 40) << line.name();
    EXPECT_LT(off, line.knowable() + 0.05) << line.name();
    // A thin line passes from one row to the next within a few pixels, and looks steeper there.
    EXPECT_LT(degrees / count, 5) << line.name();
    EXPECT_LT(worst, line.width <= 0.5 ? 17 : 5) << line.name();
    EXPECT_NEAR(sum / count, line.width, 0.1 * line.width + 0.04) << line.name();
  });
}

TEST(FindLines, FollowARing) {
  const dvec2 centre(31.3, 30.8);
  for (const double width : {0.3, 1.0}) {
    Drawing drawing(kSize, kSize);
    for (int i = 0; i < 180; ++i) {
      const auto corner = [&](int at, double radius) {
        const double angle = at * std::numbers::pi / 90;
        return centre + radius * dvec2(std::cos(angle), std::sin(angle));
      };
      drawing.add({corner(i, 15 - width / 2), corner(i, 15 + width / 2),
                   corner(i + 1, 15 + width / 2), corner(i + 1, 15 - width / 2)});
    }
    const std::vector<LinePoint> points = find_lines(drawing.mask());
    EXPECT_GT(points.size(), 80u);
    for (const LinePoint& p : points)
      EXPECT_NEAR(glm::distance(dvec2(p.x, p.y), centre), 15, std::max(0.2, 0.5 * (1 - width)));
  }
}

TEST(FindLines, NoneOnADiscNorInABand) {
  for (const double off : {0.0, 0.3, 0.5}) {
    Drawing disc(kSize, kSize);
    disc.add_disc({31 + off, 32 - off / 2}, 20);
    EXPECT_TRUE(find_lines(disc.mask()).empty());
    EXPECT_TRUE(find_lines(disc.hard_mask()).empty());
  }
  for (const double degrees : {0.0, 3.0, 18.0, 45.0, 90.0, 157.0})
    for (const double offset : {0.0, 0.25, 0.5}) {
      Drawing band(kSize, kSize);
      const Line line{6, degrees, offset};
      line.draw(band);
      EXPECT_TRUE(find_lines(band.mask()).empty()) << line.name();
      EXPECT_TRUE(find_lines(band.hard_mask()).empty()) << line.name();
    }
}

TEST(FindLines, NoneAlongANoisyOutline) {
  test::Rng rng(5);
  for (int trial = 0; trial < 40; ++trial) {
    Drawing drawing(kSize, kSize);
    if (trial % 2)
      drawing.add_disc({31, 32}, 20);
    else
      drawing.add_band({-20, trial}, {90, 50 - trial}, 24);
    Mask mask = drawing.mask();
    for (std::uint8_t& c : mask.coverage)
      if (c != 0 && c != 255) c = std::uint8_t(test::uniform(rng, 0, 256));
    EXPECT_TRUE(find_lines(mask).empty()) << trial;
  }
}

TEST(FindLines, TwoWhereTwoStandBesideEachOther) {
  for (const double width : {0.3, 1.0})
    for (const double degrees : {0.0, 30.0, 45.0, 90.0}) {
      const Line one{width, degrees, -1.9}, other{width, degrees, 2.1};
      Drawing drawing(kSize, kSize);
      one.draw(drawing), other.draw(drawing);
      const std::vector<LinePoint> points = find_lines(drawing.mask());
      EXPECT_LT(worst_gap(one, points), one.knowable()) << one.name();
      EXPECT_LT(worst_gap(other, points), other.knowable()) << other.name();
      for (const LinePoint& p : points) {
        if (!far_from_frame({p.x, p.y}, 4)) continue;
        EXPECT_LT(std::min(one.distance(p), other.distance(p)), 0.3) << one.name();
        EXPECT_NEAR(p.width, width, 0.15 * width + 0.1) << one.name();
      }
    }
}

TEST(FindLines, DashesOfAHardMask) {
  Mask mask{kSize, kSize, std::vector<std::uint8_t>(kSize * kSize, 0)};
  const auto pixel = [&](int x, int y) -> std::uint8_t& {
    return mask.coverage[std::size_t(y * kSize + x)];
  };
  for (int i = 5; i < 50; i += 6)
    for (int k = 0; k < 3; ++k) pixel(i + k, 20) = pixel(i + k, i + k) = 255;
  const std::vector<LinePoint> points = find_lines(mask);
  for (int i = 5; i < 50; i += 6) {
    const auto shows = [&](int x, int y) {
      return std::any_of(points.begin(), points.end(),
                         [&](const LinePoint& p) { return std::hypot(p.x - x, p.y - y) < 0.5; });
    };
    EXPECT_TRUE(shows(i + 1, 20)) << i;
    EXPECT_TRUE(shows(i + 1, i + 1)) << i;
  }
}

TEST(FindLines, AShortSpikeOfSomethingThickIsNone) {
  Drawing drawing(kSize, kSize);
  drawing.add_disc({31, 32}, 15);
  drawing.add({{46, 31.5}, {48.5, 31.5}, {48.5, 32.5}, {46, 32.5}});
  EXPECT_TRUE(find_lines(drawing.mask()).empty());
}

TEST(SureLines, WhereTheMiddleOfTheLineIsMoreThanAGuess) {
  Mask mask{kSize, kSize, std::vector<std::uint8_t>(kSize * kSize, 0)};
  for (int y = 0; y < kSize; ++y)
    for (const auto& [x, chance] : {std::pair(10, 150), std::pair(30, 191), std::pair(50, 230)})
      mask.coverage[std::size_t(y * kSize + x)] = std::uint8_t(chance);
  const std::vector<LinePoint> all = find_lines(mask), sure = sure_lines(mask, all);
  const auto count_at = [](const std::vector<LinePoint>& lines, double x) {
    return std::count_if(lines.begin(), lines.end(),
                         [&](const LinePoint& p) { return std::abs(p.x - x) < 1; });
  };
  for (const double x : {10, 30, 50}) EXPECT_GT(count_at(all, x), kSize / 2) << x;
  EXPECT_EQ(count_at(sure, 10), 0);
  EXPECT_EQ(count_at(sure, 30), 0);
  EXPECT_EQ(count_at(sure, 50), count_at(all, 50));
}

TEST(FindLines, NoneInMasksOfOneValueOrOneThatHoldsNoLine) {
  for (const int width : {1, 3, 8, 40})
    for (const int value : {0, 1, 128, 255})
      EXPECT_TRUE(
          find_lines(
              {width, 5, std::vector<std::uint8_t>(std::size_t(width) * 5, std::uint8_t(value))})
              .empty());
}

TEST(LineSlack, HalfAPixelForThinLinesAndNoneForThickOnes) {
  EXPECT_EQ(line_slack(0.1), 0.5);
  EXPECT_EQ(line_slack(1.5), 0.5);
  EXPECT_NEAR(line_slack(2), 0.25, 1e-12);
  EXPECT_EQ(line_slack(kWidestLine), 0);
  EXPECT_EQ(line_slack(9), 0);
}

TEST(WidenLines, TheInterpolatedDistanceIsNegativeAllAlongTheMiddle) {
  for_lines([](const Line& line) {
    Mask mask = line.mask();
    widen_lines(find_lines(mask), mask);
    const SilhouetteDistance distance = silhouette_distance(mask);
    double worst = -1e9;
    for (double t = -kSize; t < kSize; t += 0.05)
      if (far_from_frame(line.at(t), 4)) worst = std::max(worst, bilinear(distance, line.at(t)));
    EXPECT_LT(worst, 0) << line.name();
  });
}

TEST(WidenLines, AsWideAsTheSlackSays) {
  for (const double width : kWidths) {
    const Line line{width, 18, 0.2};
    Mask mask = line.mask();
    widen_lines(find_lines(mask), mask);
    const SilhouetteDistance distance = silhouette_distance(mask);
    for (double t = -20; t < 20; t += 0.3)
      for (const double side : {-1.0, 1.0})
        EXPECT_NEAR(bilinear(distance, line.at(t) + side * 2.0 * line.across()),
                    2 - width / 2 - line_slack(width), 0.25)
            << width;
  }
}

TEST(WidenLines, LowersNoPixelAndTouchesNothingFarAway) {
  test::Rng rng(9);
  for (const double width : kWidths) {
    const Line line{width, 30, 0.1};
    Drawing drawing(kSize, kSize);
    line.draw(drawing);
    Mask mask = drawing.mask();
    const std::vector<LinePoint> lines = find_lines(mask);
    ASSERT_FALSE(lines.empty());
    for (std::uint8_t& c : mask.coverage) c = std::max(c, std::uint8_t(test::uniform(rng, 0, 256)));
    const Mask before = mask;
    widen_lines(lines, mask);
    for (int i = 0; i < kSize * kSize; ++i) {
      const auto at = std::size_t(i);
      EXPECT_GE(mask.coverage[at], before.coverage[at]);
      const dvec2 p(i % kSize, i / kSize);
      if (std::abs(glm::dot(p - line.at(0), line.across())) <= 3) continue;
      EXPECT_EQ(mask.coverage[at], before.coverage[at]);
    }
    Mask same = before;
    widen_lines({}, same);
    EXPECT_EQ(same.coverage, before.coverage);
  }
}

}  // namespace
}  // namespace photohull
