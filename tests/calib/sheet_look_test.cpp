#include "calib/sheet_look.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sheet/draw_sheet.h"
#include "sheet/sheet.h"

namespace photohull {
namespace {

constexpr int kWidth = 420, kHeight = 594;  // two pixels to a millimetre of A4

/// A camera high above the middle of the sheet, which fills its picture.
PoseResult from_above(const Sheet& sheet) {
  PoseResult result;
  const double height = 1000;
  const glm::dvec2 middle = sheet.lower_left + 0.5 * sheet.page;
  result.cameras.push_back({});
  result.cameras[0].intrinsics = {
      kWidth, kHeight, 2 * height, 2 * height, 0, (kWidth - 1) / 2.0, (kHeight - 1) / 2.0};
  result.photos.push_back({});
  result.photos[0].posed = true;
  Pose& pose = result.photos[0].cam_from_world;
  pose.rotation = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
  pose.translation = -(pose.rotation * glm::dvec3(middle, height));
  result.box = {glm::dvec3(-10, -10, 1), glm::dvec3(10, 10, 30)};
  return result;
}

class SheetLookTest : public testing::Test {
 protected:
  SheetLook look(const std::vector<LocalBlur>& blur) const {
    return look_at_sheet(result_, 0, sheet_, picture_, blur);
  }
  /// The root mean square of the differences within some pixels of a place.
  static double difference(const SheetLook& a, const SheetLook& b, const glm::ivec2& at) {
    constexpr int kReach = 40;
    double sum = 0;
    int count = 0;
    for (int y = std::max(0, at.y - kReach); y < std::min(kHeight, at.y + kReach); ++y)
      for (int x = std::max(0, at.x - kReach); x < std::min(kWidth, at.x + kReach); ++x) {
        const std::size_t i = std::size_t(y) * kWidth + std::size_t(x);
        if (a.light[i] < 0 || b.light[i] < 0) continue;
        sum += std::pow(double(a.light[i]) - double(b.light[i]), 2), ++count;
      }
    return std::sqrt(sum / count);
  }

  Sheet sheet_ = make_sheet({});
  SheetPicture picture_ = sheet_picture(sheet_, 4);
  PoseResult result_ = from_above(sheet_);
  const glm::ivec2 upper_{60, 60}, lower_{360, 500};  // where there are tags
};

TEST_F(SheetLookTest, BlurIsThatOfThePlacesNearby) {
  const SheetLook little = look({{glm::dvec2(0), 0.6}}), much = look({{glm::dvec2(0), 2.6}});
  const SheetLook mixed = look({{upper_, 0.6}, {lower_, 2.6}});
  for (const glm::ivec2& at : {upper_, lower_})
    EXPECT_GT(difference(little, much, at), 0.03) << "tags are there";
  EXPECT_LT(difference(mixed, little, upper_), 0.15 * difference(much, little, upper_));
  EXPECT_LT(difference(mixed, much, lower_), 0.15 * difference(much, little, lower_));
}

TEST_F(SheetLookTest, TheSameBlurEverywhereIsOneGaussian) {
  const SheetLook one = look({{upper_, 1.3}}), two = look({{upper_, 1.3}, {lower_, 1.3}});
  EXPECT_EQ(one.light, two.light);
  EXPECT_EQ(one.mixed, two.mixed);
  const SheetLook nearly = look({{upper_, 1.3}, {lower_, 1.36}});
  EXPECT_LT(difference(one, nearly, upper_), 0.003);
}

TEST_F(SheetLookTest, WithoutBlurItIsSharp) {
  EXPECT_EQ(look({}).light, look({{upper_, 0}, {lower_, 0}}).light);
  EXPECT_GT(difference(look({}), look({{upper_, 0.6}}), upper_), 0.01);
}

TEST(BlurOfEdges, IsWhatAPixelsAreaDoesNotExplain) {
  const std::vector<EdgeWidth> edges = {{{100, 50}, 0.1}, {{10, 20}, 1.68}};
  const std::vector<LocalBlur> blur = blur_of_edges(edges);
  EXPECT_EQ(blur[0].deviation, 0);
  EXPECT_NEAR(blur[1].deviation, std::sqrt(1 - 1 / 12.0), 1e-9);
  const std::vector<LocalBlur> halved = blur_of_edges(edges, 0.5);
  EXPECT_EQ(halved[0].at, glm::dvec2(50, 25));
  EXPECT_NEAR(halved[1].deviation, std::sqrt(0.25 - 1 / 12.0), 1e-9);
}

}  // namespace
}  // namespace photohull
