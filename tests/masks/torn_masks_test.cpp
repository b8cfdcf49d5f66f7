#include "masks/torn_masks.h"

#include <gtest/gtest.h>

#include "support/pictures.h"

namespace photohull {
namespace {

constexpr int kWidth = 220, kHeight = 180;

double disc(double x, double y, double cx, double cy, double radius) {
  return std::clamp(radius + 0.5 - std::hypot(x - cx, y - cy), 0.0, 1.0);
}

/// A disc with an opening on the right.
double object(double x, double y) { return disc(x, y, 110, 90, 60) - disc(x, y, 140, 90, 12); }

/// Stripes of warm colours on cold ones.
glm::vec3 picture(double x, double y) {
  const float light = 0.5f + 0.3f * float(std::sin(0.7 * x) * std::cos(0.5 * y));
  return glm::mix(glm::vec3(0.05f, 0.1f, 0.4f) * light, glm::vec3(0.8f, 0.4f, 0.1f) * light,
                  float(object(x, y)));
}

std::int64_t differing(const Mask& a, const Mask& b) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.coverage.size(); ++i)
    count += std::abs(int(a.coverage[i]) - int(b.coverage[i])) > 25;
  return count;
}

Mask whole() { return paint_mask(kWidth, kHeight, object); }

/// With a hole of 6 pixels inside, one of 20, and a bite at the outline.
Mask torn() {
  return paint_mask(kWidth, kHeight, [](double x, double y) {
    return std::min({object(x, y), 1 - disc(x, y, 90, 120, 6), 1 - disc(x, y, 95, 75, 20),
                     1 - disc(x, y, 110, 148, 6)});
  });
}

TEST(MendMask, FillsWhereThePhotographShowsTheObject) {
  for (const bool half : {false, true}) {
    const ColourImage image =
        half ? paint_half(kWidth, kHeight, picture) : paint_srgb(kWidth, kHeight, picture);
    Mask mask = torn();
    const auto before = differing(mask, whole());
    const MendedMask found = mend_mask(image, mask);
    EXPECT_EQ(found.holes, 3);
    EXPECT_NEAR(found.share, 0.15, 0.05);
    EXPECT_LT(differing(mask, whole()), before / 50);  // what is left lies at the bite's rim
  }
}

TEST(MendMask, RealOpeningsStay) {
  Mask mask = whole();
  EXPECT_EQ(mend_mask(paint_srgb(kWidth, kHeight, picture), mask).holes, 0);
  EXPECT_EQ(differing(mask, whole()), 0);
}

TEST(MendMask, JudgesNothingWhereObjectAndBackgroundLookAlike) {
  const ColourImage image = paint_srgb(kWidth, kHeight, [](double x, double y) {
    return glm::vec3(0.4f + 0.2f * float(std::sin(0.7 * x) * std::cos(0.5 * y)));
  });
  Mask mask = torn();
  EXPECT_EQ(mend_mask(image, mask).holes, 0);
  EXPECT_EQ(differing(mask, torn()), 0);
}

TEST(MendMask, LargePicturesInCells) {
  const auto large = [](double x, double y) { return picture(x / 6, y / 6); };
  const ColourImage image = paint_srgb(6 * kWidth + 5, 6 * kHeight + 1, large);
  const auto holed = [](double x, double y) {
    return std::min(object(x / 6, y / 6), 1 - disc(x, y, 540, 720, 40));
  };
  Mask mask = paint_mask(image.width, image.height, holed);
  const Mask right = paint_mask(image.width, image.height,
                                [](double x, double y) { return object(x / 6, y / 6); });
  EXPECT_EQ(mend_mask(image, mask).holes, 1);
  EXPECT_LT(differing(mask, right), 100);
}

TEST(MendMask, EmptyAndFullMasksStay) {
  const ColourImage image = paint_srgb(kWidth, kHeight, picture);
  for (const double value : {0.0, 1.0}) {
    Mask mask = paint_mask(kWidth, kHeight, [&](double, double) { return value; });
    const Mask before = mask;
    EXPECT_EQ(mend_mask(image, mask).holes, 0);
    EXPECT_EQ(mask.coverage, before.coverage);
  }
}

}  // namespace
}  // namespace photohull
