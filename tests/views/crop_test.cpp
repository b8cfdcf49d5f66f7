#include "views/crop.h"

#include <gtest/gtest.h>

namespace photohull {
namespace {

/// Every pixel knows its own position: red is x, green is y.
PreparedView numbered_view() {
  PreparedView view;
  view.camera.intrinsics = {100, 80, 120.0, 118.0, 0.7, 48.3, 41.2};
  view.camera.cam_from_world.translation = {0, 0, 5};
  view.image = {100, 80, ColourImage::Encoding::kSrgb8, false, {}};
  view.mask = {100, 80, {}};
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 100; ++x) {
      view.image.bytes.insert(view.image.bytes.end(), {std::uint8_t(x), std::uint8_t(y), 0, 255});
      view.mask.coverage.push_back(std::uint8_t(x + y));
    }
  return view;
}

TEST(CropToBox, KeepsWhatEveryPointOfTheBoxSees) {
  const PreparedView whole = numbered_view();
  PreparedView cropped = whole;
  const Box box{{-0.4, -0.3, -0.5}, {0.5, 0.2, 0.5}};
  crop_to_box(box, 3, cropped);
  EXPECT_LT(cropped.image.width, 50);
  EXPECT_EQ(cropped.image.width, cropped.camera.intrinsics.width);
  EXPECT_EQ(cropped.mask.height, cropped.camera.intrinsics.height);
  EXPECT_EQ(cropped.image.bytes.size(),
            std::size_t(cropped.image.width) * cropped.image.height * 4);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1 ? box.max : box.min).x, (corner & 2 ? box.max : box.min).y,
                           (corner & 4 ? box.max : box.min).z);
    const glm::dvec2 before = *whole.camera.project(point), after = *cropped.camera.project(point);
    ASSERT_TRUE(cropped.camera.on_image(after));
    const glm::ivec2 shift(glm::round(before - after));
    EXPECT_NEAR(glm::length(before - after - glm::dvec2(shift)), 0, 1e-9);
    const std::size_t at = std::size_t(int(after.y)) * cropped.image.width + int(after.x);
    EXPECT_EQ(cropped.image.bytes[at * 4], int(after.x) + shift.x);
    EXPECT_EQ(cropped.image.bytes[at * 4 + 1], int(after.y) + shift.y);
    EXPECT_EQ(cropped.mask.coverage[at], int(after.x) + shift.x + int(after.y) + shift.y);
  }
}

TEST(CropToBox, SilhouettesGoWithThePixels) {
  PreparedView view = numbered_view();
  ViewSilhouette& silhouette = view.silhouette;
  silhouette.widened = view.mask;
  silhouette.distance = {100, 80, {}};
  for (int i = 0; i < 100 * 80; ++i)
    silhouette.distance.pixels.push_back(float(i % 100) - 0.5f * float(i / 100));
  silhouette.lines = {{40, 35, 1, 0, 0.5f}, {2, 3, 0, 1, 0.7f}, {48.5f, 41.25f, 0, 1, 0.9f}};
  for (const int multiple : {1, 8, 32}) {
    PreparedView cropped = view;
    crop_to_box({{-0.4, -0.3, -0.5}, {0.5, 0.2, 0.5}}, 3, cropped, multiple);
    const int x = cropped.image.bytes[0], y = cropped.image.bytes[1];  // of the first pixel
    EXPECT_EQ(x % multiple, 0);
    EXPECT_EQ(y % multiple, 0);
    EXPECT_EQ(cropped.camera.intrinsics.cx, 48.3 - x);
    EXPECT_EQ(cropped.silhouette.widened.coverage, cropped.mask.coverage);
    const SilhouetteDistance& distance = cropped.silhouette.distance;
    ASSERT_EQ(distance.width, cropped.image.width);
    ASSERT_EQ(distance.height, cropped.image.height);
    ASSERT_EQ(distance.pixels.size(), std::size_t(distance.width) * std::size_t(distance.height));
    EXPECT_EQ(distance.pixels.front(), float(x) - 0.5f * float(y));
    EXPECT_EQ(distance.pixels.back(),
              float(x + distance.width - 1) - 0.5f * float(y + distance.height - 1));
    ASSERT_EQ(cropped.silhouette.lines.size(), 2u) << "one lies where nothing is left";
    EXPECT_EQ(cropped.silhouette.lines[0].x, float(40 - x));
    EXPECT_EQ(cropped.silhouette.lines[1].y, 41.25f - float(y));
    EXPECT_EQ(cropped.silhouette.lines[1].width, 0.9f);
  }
}

TEST(CropToBox, LeavesAViewThatCannotBeCut) {
  for (const Box& box : {Box{{-1, -1, -6}, {1, 1, 1}},         // partly behind the camera
                         Box{{90, 90, 0}, {91, 91, 1}},        // off the image
                         Box{{-9, -9, -0.1}, {9, 9, 0.1}}}) {  // larger than the image
    PreparedView view = numbered_view();
    crop_to_box(box, 3, view);
    EXPECT_EQ(view.image.width, 100);
    EXPECT_EQ(view.image.bytes.size(), 100u * 80u * 4u);
    EXPECT_DOUBLE_EQ(view.camera.intrinsics.cx, 48.3);
  }
}

TEST(CropToBox, AViewWithoutMaskStaysWithoutOne) {
  PreparedView view = numbered_view();
  view.mask.coverage.clear();
  crop_to_box({{-0.4, -0.3, -0.5}, {0.5, 0.2, 0.5}}, 0, view);
  EXPECT_TRUE(view.mask.empty());
}

}  // namespace
}  // namespace photohull
