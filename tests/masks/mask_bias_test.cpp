#include "masks/mask_bias.h"

#include <gtest/gtest.h>

#include "masks/drawn_masks.h"
#include "masks/silhouette.h"
#include "support/ray_cast.h"
#include "support/silhouettes.h"

namespace photohull {
namespace {

/// Null for views without a mask.
std::vector<const SilhouetteDistance*> given(const std::vector<SilhouetteDistance>& silhouettes) {
  std::vector<const SilhouetteDistance*> out;
  for (const SilhouetteDistance& s : silhouettes) out.push_back(s.pixels.empty() ? nullptr : &s);
  return out;
}

constexpr int kSize = 160;

/// A textured ball on grey, with masks whose contours lie `grown` pixels outside its outline.
struct Scene {
  std::vector<PreparedView> views;
  std::vector<SilhouetteDistance> silhouettes;

  explicit Scene(double grown, double background = 0.02, double texture = 0.2) {
    for (const Camera& camera : test::cameras_around({0, 0, 0}, 6, 6, 300, kSize, kSize)) {
      PreparedView view;
      view.camera = camera;
      view.image = test::ray_cast(camera, [&](const glm::dvec3& eye, const glm::dvec3& ray) {
        const double b = glm::dot(eye, ray), c = glm::dot(eye, eye) - 1;
        return b * b < c ? glm::dvec3(background)
                         : test::noise_colour(eye + (-b - std::sqrt(b * b - c)) * ray, texture);
      });
      const test::Outline exact = test::sphere_outline(camera, {0, 0, 0}, 1);
      const test::Outline outline = test::rasterise(kSize, kSize, [&](const glm::dvec2& p) {
        return double(exact.distance.pixels[std::size_t(p.y) * kSize + std::size_t(p.x)]) - grown;
      });
      view.mask = outline.mask;
      silhouettes.push_back(outline.distance);
      views.push_back(std::move(view));
    }
  }

  MaskBias measure() const { return measure_mask_bias(views, given(silhouettes)); }
};

TEST(MaskBias, FindsByHowMuchMasksAreTooSmallOrTooLarge) {
  for (const double grown : {-12.0, -3.0, -1.0, 1.0, 3.0, 12.0}) {
    const MaskBias bias = Scene(grown).measure();
    EXPECT_NEAR(bias.pixels, -grown, 0.35) << grown;
    EXPECT_GT(bias.agreement, 0.9) << grown;
    EXPECT_TRUE(bias.counts()) << grown;
  }
}

TEST(MaskBias, ExactMasksStay) {
  const MaskBias bias = Scene(0).measure();
  EXPECT_NEAR(bias.pixels, 0, 0.35);
  EXPECT_FALSE(bias.counts());
}

TEST(MaskBias, TheOutlineShowsBeforeClutterToo) {
  Scene scene(3);
  test::Rng rng(5);
  for (PreparedView& view : scene.views) {
    const ColourImage clutter = test::random_image(rng, kSize, kSize);
    const test::Outline exact = test::sphere_outline(view.camera, {0, 0, 0}, 1);
    for (std::size_t i = 0; i < exact.distance.pixels.size(); ++i)
      if (exact.distance.pixels[i] > 0)
        std::copy_n(&clutter.bytes[4 * i], 4, &view.image.bytes[4 * i]);
  }
  EXPECT_NEAR(scene.measure().pixels, -3, 0.35);
}

TEST(MaskBias, WhereNothingTellsObjectFromBackgroundMasksStay) {
  Scene scene(3);
  test::Rng rng(5);
  for (PreparedView& view : scene.views) view.image = test::random_image(rng, kSize, kSize);
  const MaskBias bias = scene.measure();
  EXPECT_FALSE(bias.counts()) << bias.pixels << ", contrast " << bias.contrast;
}

TEST(MaskBias, NoMasksNoBias) {
  Scene scene(3);
  for (auto& s : scene.silhouettes) s = {};
  EXPECT_FALSE(scene.measure().counts());
  EXPECT_FALSE(measure_mask_bias({}, {}).counts());
}

/// Bands in many directions, as a light object on black shows them, and masks of bands whose widths
/// are others.
std::pair<std::vector<PreparedView>, std::vector<SilhouetteDistance>> bands(double width,
                                                                            double width_in_mask) {
  std::vector<PreparedView> views(4);
  std::vector<SilhouetteDistance> silhouettes;
  for (std::size_t k = 0; k < views.size(); ++k) {
    test::Drawing photograph(kSize, kSize), masks(kSize, kSize);
    for (int i = 0; i < 8; ++i) {
      const double angle = 0.1 * double(k) + 0.05 * i;
      const glm::dvec2 middle(18 + 17.3 * i, 80.2 + 0.3 * i),
          half = 50.0 * glm::dvec2(std::sin(angle), std::cos(angle));
      photograph.add_band(middle - half, middle + half, width);
      masks.add_band(middle - half, middle + half, width_in_mask);
    }
    views[k].mask = masks.mask();
    silhouettes.push_back(silhouette_distance(views[k].mask));
    views[k].image.width = views[k].image.height = kSize;
    for (const std::uint8_t c : photograph.mask().coverage)
      views[k].image.bytes.insert(views[k].image.bytes.end(), {c, c, c, 255});
  }
  return {std::move(views), std::move(silhouettes)};
}

TEST(MaskBias, ThinStemsOfRightMasksAreNotEaten) {
  for (const double width : {0.3, 0.5, 0.7, 1.0, 1.4, 2.0}) {
    const auto [views, silhouettes] = bands(width, width);
    EXPECT_FALSE(measure_mask_bias(views, given(silhouettes)).counts()) << width;
  }
}

TEST(MaskBias, WiresThatWereEatenAre) {
  for (const double width : {3.0, 4.0, 6.0}) {
    const auto [views, silhouettes] = bands(width, width - 2);
    const MaskBias bias = measure_mask_bias(views, given(silhouettes));
    EXPECT_TRUE(bias.counts()) << width;
    EXPECT_NEAR(bias.pixels, 1, 0.25) << width;
  }
}

TEST(MoveOutline, OutwardTakesNothingFromStemsWithoutAnOutline) {
  auto [views, silhouettes] = bands(0.3, 0.3);
  const std::vector<std::uint8_t> before = views[0].mask.coverage;
  move_outline(1, views[0].mask, silhouettes[0]);
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_GE(views[0].mask.coverage[i], before[i]);
  EXPECT_EQ(*std::max_element(before.begin(), before.end()),
            *std::max_element(views[0].mask.coverage.begin(), views[0].mask.coverage.end()));
}

TEST(MoveOutline, MovesMaskAndDistancesAlike) {
  Scene scene(-3);
  move_outline(3, scene.views[0].mask, scene.silhouettes[0]);
  const Scene exact(0);
  for (std::size_t i = 0; i < exact.silhouettes[0].pixels.size(); ++i) {
    EXPECT_NEAR(scene.silhouettes[0].pixels[i], exact.silhouettes[0].pixels[i], 1e-3);
    EXPECT_NEAR(scene.views[0].mask.coverage[i], exact.views[0].mask.coverage[i], 1);
  }
  SilhouetteDistance none{2, 1, {SilhouetteDistance::kNoContour, -SilhouetteDistance::kNoContour}};
  Mask mask{2, 1, {0, 255}};
  move_outline(5, mask, none);
  EXPECT_EQ(none.pixels[0], SilhouetteDistance::kNoContour);
  EXPECT_EQ(mask.coverage, (std::vector<std::uint8_t>{0, 255}));
}

}  // namespace
}  // namespace photohull
