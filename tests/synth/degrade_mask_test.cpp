#include "synth/degrade_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/image.h"
#include "synth/place_cameras.h"

namespace photohull::synth {
namespace {

/// A soft-edged disc.
Mask disc(double radius) {
  Mask mask{120, 100, {}};
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 120; ++x)
      mask.coverage.push_back(std::uint8_t(
          std::lround(255 * std::clamp(radius - std::hypot(x - 60, y - 50) + 0.5, 0.0, 1.0))));
  return mask;
}

double area(const Mask& mask) {
  return std::accumulate(mask.coverage.begin(), mask.coverage.end(), 0.0) / 255;
}

TEST(MaskErrors, GrowAndShrinkByThePixelsAskedFor) {
  for (const double pixels : {-4.0, -1.5, 1.0, 3.0, 6.5}) {
    DegradationSpec spec;
    spec.mask_grow = pixels;
    const double radius = std::sqrt(area(degrade_mask(disc(30), spec, 1, 0)) / M_PI);
    EXPECT_NEAR(radius, 30 + pixels, 0.06) << pixels;
  }
}

TEST(MaskErrors, HolesHaveTheirSizeAndNumber) {
  DegradationSpec spec;
  spec.mask_holes = 1, spec.mask_hole_radius = 5;
  double lost = 0;
  int whole = 0;
  for (std::size_t view = 0; view < 40; ++view) {
    const double taken = area(disc(40)) - area(degrade_mask(disc(40), spec, 1, view));
    lost = std::max(lost, taken);
    whole += taken > M_PI * 25 - 1;
    EXPECT_GT(taken, 0.3 * M_PI * 25);  // centred on the foreground
  }
  EXPECT_NEAR(lost, M_PI * 25, 1.0);
  EXPECT_GT(whole, 20);
  spec.mask_holes = 5;
  EXPECT_GT(area(disc(40)) - area(degrade_mask(disc(40), spec, 1, 0)), 1.5 * M_PI * 25);
}

TEST(MaskErrors, NoneLeavesTheMaskAlone) {
  EXPECT_EQ(degrade_mask(disc(20), {}, 1, 0).coverage, disc(20).coverage);
}

/// What a picture tells of an object whose coverage and depth at the centres are known.
Picture picture_of(const Mask& mask, const std::function<bool(int x, int y)>& centre) {
  Picture p;
  p.width = mask.width, p.height = mask.height;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      p.coverage.push_back(mask.coverage[std::size_t(y) * mask.width + x] / 255.0f);
      p.depth.push_back(centre(x, y) ? 2.0f : 0.0f);
    }
  return p;
}

/// As `synthesize` makes it.
Mask styled(const Picture& picture, const std::string& style, double cut = 0.5) {
  DegradationSpec spec;
  spec.mask_style = style, spec.mask_cut = cut;
  return degrade_mask(undegraded_mask(picture, spec), spec, 1, 0);
}

bool is_binary(const Mask& mask) {
  return std::all_of(mask.coverage.begin(), mask.coverage.end(),
                     [](std::uint8_t v) { return v == 0 || v == 255; });
}

/// An upright strip from x = `from` to `to`, pixel x reaching from x - 0.5 to x + 0.5.
Picture strip(double from, double to) {
  Mask mask{40, 20, {}};
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x)
      mask.coverage.push_back(std::uint8_t(
          std::lround(255 * std::max(0.0, std::min(to, x + 0.5) - std::max(from, x - 0.5)))));
  return picture_of(mask, [&](int x, int) { return x >= from && x <= to; });
}

/// Columns of a strip's mask that are not 0, each the same from the top to the bottom row.
std::vector<int> columns(const Mask& mask) {
  std::vector<int> found;
  for (int x = 0; x < mask.width; ++x) {
    for (int y = 1; y < mask.height; ++y)
      EXPECT_EQ(mask.coverage[std::size_t(y) * mask.width + x], mask.coverage[x]) << x << " " << y;
    if (mask.coverage[x] > 0) found.push_back(x);
  }
  return found;
}

TEST(MaskStyles, CutAndCentresKeepTheAreaOfADiscAndErosionTakesItsRim) {
  const Picture picture =
      picture_of(disc(30), [](int x, int y) { return std::hypot(x - 60, y - 50) <= 30; });
  EXPECT_EQ(styled(picture, "coverage").coverage, disc(30).coverage);
  for (const char* style : {"aliased", "cut", "eroded"})
    EXPECT_TRUE(is_binary(styled(picture, style))) << style;
  EXPECT_NEAR(area(styled(picture, "aliased")), M_PI * 900, 15);
  EXPECT_NEAR(area(styled(picture, "cut")), M_PI * 900, 15);
  EXPECT_GT(area(styled(picture, "cut", 0.05)), M_PI * 900 + 50);
  EXPECT_LT(area(styled(picture, "cut", 1)), M_PI * 900 - 50);
  // A cross takes a pixel along rows and columns and less in between.
  const double eroded = std::sqrt(area(styled(picture, "eroded")) / M_PI);
  EXPECT_LT(eroded, 29.3);
  EXPECT_GT(eroded, 28.9);
}

TEST(MaskStyles, ThinStripsStayOrGoByWhereTheyLie) {
  using Columns = std::vector<int>;
  const Picture on = strip(9.9, 10.3), off = strip(10.1, 10.5);  // 0.4 pixels wide
  EXPECT_EQ(styled(off, "coverage").coverage[10], 102);
  EXPECT_EQ(columns(styled(on, "aliased")), Columns{10});
  EXPECT_EQ(columns(styled(off, "aliased")), Columns{});
  for (const Picture& picture : {on, off}) {
    EXPECT_EQ(columns(styled(picture, "cut")), Columns{});
    EXPECT_EQ(columns(styled(picture, "cut", 0.41)), Columns{});
    EXPECT_EQ(columns(styled(picture, "cut", 0.4)), Columns{10});  // at least, not more than
    EXPECT_EQ(columns(styled(picture, "eroded", 0.3)), Columns{});
  }
  const Picture wide = strip(9.5, 11.9);  // two pixels whole, the third by 0.4
  EXPECT_EQ(columns(styled(wide, "aliased")), (Columns{10, 11}));
  EXPECT_EQ(columns(styled(wide, "cut")), (Columns{10, 11}));
  EXPECT_EQ(columns(styled(wide, "cut", 0.3)), (Columns{10, 11, 12}));
  EXPECT_EQ(columns(styled(wide, "eroded")), Columns{});
  EXPECT_EQ(columns(styled(wide, "eroded", 0.3)), Columns{11});
}

TEST(MaskStyles, ComeAfterGrowingAndBeforeHoles) {
  DegradationSpec spec;
  spec.mask_style = "cut", spec.mask_grow = 3;
  EXPECT_NEAR(std::sqrt(area(degrade_mask(disc(30), spec, 1, 0)) / M_PI), 33, 0.1);
  spec.mask_style = "eroded", spec.mask_grow = 0;
  spec.mask_holes = 3, spec.mask_hole_radius = 4;
  const Mask torn = degrade_mask(disc(30), spec, 1, 0);
  EXPECT_TRUE(is_binary(torn));
  const Mask whole = styled(picture_of(disc(30), [](int, int) { return false; }), "eroded");
  const double lost = area(whole) - area(torn);
  // Erosion after the holes would take more than three of them.
  EXPECT_GT(lost, M_PI * 16);
  EXPECT_LT(lost, 3 * M_PI * 17);
}

}  // namespace
}  // namespace photohull::synth
