// What the formulas of colour and confidence promise, on their reference.
#include <gtest/gtest.h>

#include <cmath>

#include "render/bake_colour.h"
#include "support/ray_cast.h"

namespace photohull::render::reference {
namespace {

constexpr double kNoise = 0.01;
const GridSpec kGrid{{0, 0, 0}, 1, {4, 4, 4}};
const glm::dvec3 kPoint{16, 16, 16};
const glm::dvec3 kNormal{0, 0, -1};

/// Views from `angles` (degrees from the normal), each of one plain colour; nothing hides anything.
class Rig {
 public:
  Rig(std::vector<double> angles, std::vector<glm::dvec3> colours) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double a = angles[i] * 3.14159265358979323846 / 180;
      const glm::dvec3 eye = kPoint + 60.0 * glm::dvec3(std::sin(a), 0, -std::cos(a));
      const Camera camera = test::look_at(eye, kPoint, 60, 32, 32, {0, 1, 0});
      images_.push_back(test::ray_cast(
          camera, [&](const glm::dvec3&, const glm::dvec3&) { return colours[i]; }, 1));
      BakeView view{projtex::to_grid(camera, kGrid), {{32, 32, 0, 0}, {1, 0, 0, 0}}, {}, nullptr};
      view.depths.assign(32 * 32, 1e30);
      views_.push_back(std::move(view));
    }
    for (std::size_t i = 0; i < views_.size(); ++i) views_[i].image = &images_[i];
  }
  BakedVertex bake() const { return bake_vertex(views_, kNoise, kPoint, kNormal); }

 private:
  std::vector<ColourImage> images_;
  std::vector<BakeView> views_;
};

double confidence(std::vector<double> angles) {
  std::vector<glm::dvec3> same(angles.size(), glm::dvec3(0.3));
  return Rig(std::move(angles), std::move(same)).bake().confidence;
}

TEST(BakeReference, ConfidenceGrowsWithViewsAndTheirSpread) {
  EXPECT_EQ(confidence({}), 0);
  EXPECT_EQ(confidence({85}), 0) << "too flat to say anything";
  EXPECT_NEAR(confidence({0}), 0.05, 1e-6);
  EXPECT_LT(confidence({0}), confidence({-5, 5}));
  EXPECT_LT(confidence({-5, 5}), confidence({-20, 20}));
  EXPECT_LT(confidence({-20, 20}), confidence({-20, 0, 20}) + 1e-6);
  EXPECT_LT(confidence({-20, 0, 20}), confidence({-20, -20, 0, 20, 20}));
  EXPECT_LT(confidence({-60, -40, -20, 0, 20, 40, 60}), 1.0 + 1e-12);
}

TEST(BakeReference, DisagreementLowersConfidence) {
  const std::vector<double> angles{-20, 0, 20};
  const glm::dvec3 grey(0.3);
  const double agreed = Rig(angles, {grey, grey, grey}).bake().confidence;
  const double slight = Rig(angles, {grey, grey, glm::dvec3(0.33)}).bake().confidence;
  const double strong = Rig(angles, {grey, glm::dvec3(0.5), glm::dvec3(0.1)}).bake().confidence;
  EXPECT_LT(slight, agreed);
  EXPECT_LT(strong, slight);
  EXPECT_GT(slight, 0.5 * agreed);
}

TEST(BakeReference, OneHighlightHasNoSay) {
  const glm::dvec3 brown(0.3, 0.2, 0.1), white(1);
  const glm::dvec3 colour =
      Rig({-30, -15, 0, 15, 30}, {brown, brown, white, brown, brown}).bake().colour;
  EXPECT_LT(glm::distance(colour, brown), 0.02);
}

TEST(BakeReference, UnknownPixelsAreNotColours) {
  ColourImage image;
  image.width = image.height = 8;
  image.bytes.assign(8 * 8 * 4, 0);
  BakeView view{
      projtex::to_grid(test::look_at(kPoint - glm::dvec3(0, 0, 60), kPoint, 20, 8, 8, {0, 1, 0}),
                       kGrid),
      {{8, 8, 0, 0}, {1, 0, 0, 0}},
      std::vector<double>(64, 1e30),
      &image};
  EXPECT_EQ(bake_vertex({&view, 1}, kNoise, kPoint, kNormal).confidence, 0);
}

TEST(BakeReference, SamplesMeansOfPixels) {
  test::Rng rng(1);
  const ColourImage image = test::random_image(rng, 8, 8);
  const glm::dvec4 pixel = sample(image, {3, 5}, 0);
  EXPECT_NEAR(pixel.g, image.linear(3, 5).g, 1e-6);
  glm::dvec4 mean(0);
  for (int y = 4; y < 6; ++y)
    for (int x = 2; x < 4; ++x) mean += 0.25 * glm::dvec4(image.linear(x, y));
  EXPECT_NEAR(sample(image, {2.5, 4.5}, 1).r, mean.r, 1e-6);
}

}  // namespace
}  // namespace photohull::render::reference
