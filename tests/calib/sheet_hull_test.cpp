// What masks on a sheet say together, and how high photographs see.
#include "calib/sheet_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "calib/seen_height.h"

namespace photohull {
namespace {

constexpr int kWidth = 160, kHeight = 120, kPhotos = 8;
constexpr double kRadius = 20;  // of the ball, mm
const glm::dvec3 kMiddle(10, 0, 25);

/// Looks at the middle from `distance` mm.
Camera camera_at(double azimuth, double elevation, double distance) {
  const glm::dvec3 out(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const glm::dvec3 right = glm::normalize(glm::cross(-out, glm::dvec3(0, 0, 1)));
  Camera camera;
  camera.intrinsics = {kWidth, kHeight, 150, 150, 0, 79.5, 59.5};
  camera.cam_from_world.rotation = glm::transpose(glm::dmat3(right, glm::cross(-out, right), -out));
  camera.cam_from_world.translation = -(camera.cam_from_world.rotation * (distance * out));
  return camera;
}

class SheetHull : public testing::Test {
 protected:
  SheetHull() {
    result_.box = {{-60, -60, 0}, {60, 60, 100}};
    result_.cameras.resize(1);
    result_.cameras[0].distortion.model = DistortionModel::kBrown;
    for (int i = 0; i < kPhotos; ++i) {
      cameras_.push_back(camera_at(2 * std::numbers::pi * i / kPhotos, 0.5, 300));
      result_.cameras[0].intrinsics = cameras_.back().intrinsics;
      PosedPhoto photo;
      photo.posed = true;
      photo.cam_from_world = cameras_.back().cam_from_world;
      result_.photos.push_back(photo);
      masks_.push_back(ball(cameras_.back()));
    }
  }

  /// Does the ray through the pixel meet the ball, made larger by a factor?
  static bool meets(const Camera& camera, int x, int y, double factor = 1) {
    const glm::dvec3 d = camera.ray({x, y}), to = kMiddle - camera.center();
    return glm::length(to - glm::dot(to, d) * d) < factor * kRadius;
  }

  static Mask ball(const Camera& camera) {
    Mask mask{kWidth, kHeight, {}};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) mask.coverage.push_back(meets(camera, x, y) ? 255 : 0);
    return mask;
  }

  /// Is the ball all in the shadow, and nothing beside one that is twice as large? The hull of
  /// views from one height alone is pointed above and below, and its cells are rather too many.
  void expect_ball(const Mask& shadow, const Camera& camera) const {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool in = shadow.coverage[std::size_t(y) * kWidth + std::size_t(x)] != 0;
        if (meets(camera, x, y)) {
          EXPECT_TRUE(in) << x << " " << y;
        } else if (!meets(camera, x, y, 2)) {
          EXPECT_FALSE(in) << x << " " << y;
        }
      }
  }

  PoseResult result_;
  std::vector<Camera> cameras_;
  std::vector<Mask> masks_;
};

TEST_F(SheetHull, OtherMasksTakeAwayWhatTwoOfThemShowTooMuch) {
  for (const std::size_t wrong : {1u, 4u})
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (y < 60) masks_[wrong].coverage[std::size_t(y) * kWidth + std::size_t(x)] = 255;
  const std::vector<Mask> shadows = shadows_of_hull(result_, masks_);
  for (std::size_t i = 0; i < kPhotos; ++i) expect_ball(shadows[i], cameras_[i]);
}

TEST_F(SheetHull, WhatOneMaskMissesIsNotTakenFromTheOthers) {
  masks_[2].coverage.assign(masks_[2].coverage.size(), 0);
  const std::vector<Mask> shadows = shadows_of_hull(result_, masks_);
  for (std::size_t i = 0; i < kPhotos; ++i) expect_ball(shadows[i], cameras_[i]);
}

TEST_F(SheetHull, PhotographsWithoutMaskSayNothing) {
  result_.photos[3].posed = false;
  masks_[3] = {};
  const std::vector<Mask> shadows = shadows_of_hull(result_, masks_);
  EXPECT_TRUE(shadows[3].empty());
  expect_ball(shadows[0], cameras_[0]);
}

TEST_F(SheetHull, LensesAndScaledMasksAreHeeded) {
  // Twice the photographs' pixels, and a lens that moves the ball's picture by several pixels.
  result_.cameras[0].distortion.coefficients[2] = 0.1;
  result_.cameras[0].intrinsics = {2 * kWidth, 2 * kHeight, 300, 300, 0, 159.5, 119.5};
  const auto bent = [](double x, double y) {
    const glm::dvec2 p((x - 79.5) / 150, (y - 59.5) / 150);
    const double r2 = glm::dot(p, p);
    return glm::dvec2(x + 150 * 2 * 0.1 * p.x * p.y, y + 150 * 0.1 * (r2 + 2 * p.y * p.y));
  };
  for (std::size_t i = 0; i < kPhotos; ++i) {
    Mask mask{kWidth, kHeight, std::vector<std::uint8_t>(std::size_t(kWidth) * kHeight, 0)};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (!meets(cameras_[i], x, y)) continue;
        const glm::ivec2 at(glm::round(bent(x, y)));
        if (at.x >= 0 && at.y >= 0 && at.x < kWidth && at.y < kHeight)
          mask.coverage[std::size_t(at.y) * kWidth + std::size_t(at.x)] = 255;
      }
    masks_[i] = std::move(mask);
  }
  const std::vector<Mask> shadows = shadows_of_hull(result_, masks_);
  for (std::size_t i = 0; i < kPhotos; ++i)
    for (std::size_t k = 0; k < masks_[i].coverage.size(); ++k) {
      if (!masks_[i].coverage[k]) continue;
      EXPECT_NE(shadows[i].coverage[k], 0) << i << " " << k;
    }
}

TEST(SeenHeight, TheBoxEndsWhereTheMiddleLeavesThePhotographs) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 6; ++i) cameras.push_back(camera_at(i, 0, 300));
  // They look horizontally at the origin: 60 pixels of 150 at 300 mm.
  const Box box{{-60, -40, 1}, {60, 40, 200}};
  EXPECT_NEAR(lowered_to_seen(box, cameras).max.z, 120, 1);
  EXPECT_EQ(lowered_to_seen(box, cameras).min.z, 1);
  EXPECT_EQ(lowered_to_seen({{-60, -40, 1}, {60, 40, 100}}, cameras).max.z, 100);
  // Two that see more are not enough; three are.
  for (int i = 0; i < 2; ++i) cameras.push_back(camera_at(i, 0, 600));
  EXPECT_NEAR(lowered_to_seen(box, cameras).max.z, 120, 1);
  cameras.push_back(camera_at(3, 0, 600));
  EXPECT_EQ(lowered_to_seen(box, cameras).max.z, 200);
}

TEST(SeenHeight, StaysWherePhotographsShowNothingOfIt) {
  std::vector<Camera> cameras = {camera_at(0, 0, 300), camera_at(1, 0, 300)};
  const Box box{{-60, -40, 500}, {60, 40, 600}};
  EXPECT_EQ(lowered_to_seen(box, cameras).max.z, 600);
}

}  // namespace
}  // namespace photohull
