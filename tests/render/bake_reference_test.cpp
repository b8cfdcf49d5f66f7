// What the formulas of colour and confidence promise, on their reference.
#include <gtest/gtest.h>

#include <cmath>

#include "render/bake_colour.h"
#include "shared/bake.h"
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

SurfaceEvidence evidence(std::vector<double> angles) {
  std::vector<glm::dvec3> same(angles.size(), glm::dvec3(0.3));
  return Rig(std::move(angles), std::move(same)).bake().evidence;
}

TEST(BakeReference, ScatterGrowsWithViewsAndTheirSpread) {
  EXPECT_EQ(evidence({}).views, 0);
  EXPECT_EQ(evidence({85}).views, 0) << "too flat to say anything";
  EXPECT_EQ(evidence({0}).views, 1);
  EXPECT_NEAR(evidence({0}).scatter, 0, 1e-6);
  // Two unit vectors 60 degrees apart: their ends are 1 apart, 1 / 2 from the mean.
  EXPECT_NEAR(evidence({-30, 30}).scatter, 0.5, 1e-5);
  EXPECT_LT(evidence({-5, 5}).scatter, evidence({-20, 20}).scatter);
  EXPECT_LT(evidence({-20, 0, 20}).scatter, evidence({-20, -20, 0, 20, 20}).scatter);
  EXPECT_EQ(evidence({-60, -40, -20, 0, 20, 40, 60}).views, shaders::kMaxBakeViews);
}

TEST(BakeReference, DisagreementIsTheViewsVariance) {
  const std::vector<double> angles{-20, 0, 20};
  const glm::dvec3 grey(0.3);
  EXPECT_NEAR(Rig(angles, {grey, grey, grey}).bake().evidence.disagreement, 0, 1e-9);
  const double slight = Rig(angles, {grey, grey, glm::dvec3(0.33)}).bake().evidence.disagreement;
  const double strong =
      Rig(angles, {grey, glm::dvec3(0.5), glm::dvec3(0.1)}).bake().evidence.disagreement;
  EXPECT_GT(slight, 0);
  EXPECT_LT(slight, strong);
  // Two views of equal weight about their mean in linear light.
  const auto two = Rig({-20, 20}, {glm::dvec3(0.25), glm::dvec3(0.36)}).bake();
  const auto squared = [&](double root) { return 3 * std::pow(root - std::sqrt(two.colour.r), 2); };
  EXPECT_NEAR(two.evidence.disagreement, 0.5 * (squared(0.5) + squared(0.6)), 1e-3);
  EXPECT_NEAR(two.evidence.fine_energy, 0, 1e-9) << "plain images have no detail";
}

/// A white dot in the middle of an image of black.
ColourImage dot_image(bool with_dot) {
  ColourImage image;
  image.width = image.height = 32;
  image.bytes.assign(32 * 32 * 4, 0);
  for (std::size_t p = 3; p < image.bytes.size(); p += 4) image.bytes[p] = 255;
  if (with_dot)
    for (int y = 15; y < 17; ++y)
      for (int x = 15; x < 17; ++x)
        for (int c = 0; c < 3; ++c) image.bytes[std::size_t(4 * (y * 32 + x) + c)] = 255;
  return image;
}

TEST(BakeReference, FineDetailIsWhatStandsOut) {
  const ColourImage dot = dot_image(true), none = dot_image(false);
  const auto evidence_of = [&](const ColourImage& second) {
    std::vector<BakeView> views;
    for (const ColourImage* image : {&dot, &second}) {
      const Camera camera =
          test::look_at(kPoint - glm::dvec3(0, 0, 60), kPoint, 60, 32, 32, {0, 1, 0});
      views.push_back({projtex::to_grid(camera, kGrid),
                       {{32, 32, 0, 0}, {1, 0, 0, 0}},
                       std::vector<double>(32 * 32, 1e30),
                       image});
    }
    return bake_vertex(views, kNoise, kPoint, kNormal).evidence;
  };
  const SurfaceEvidence same = evidence_of(dot), other = evidence_of(none);
  // White less the root of the mean of 16 pixels that four are white of, bilinear: in three
  // channels.
  EXPECT_GT(same.fine_energy, 0.3);
  EXPECT_NEAR(same.fine_disagreement, 0, 1e-9);
  EXPECT_NEAR(other.fine_energy, 0.5 * same.fine_energy, 1e-6);
  EXPECT_NEAR(other.fine_disagreement, 0.25 * same.fine_energy, 1e-6);
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
  EXPECT_EQ(bake_vertex({&view, 1}, kNoise, kPoint, kNormal).evidence.views, 0);
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
