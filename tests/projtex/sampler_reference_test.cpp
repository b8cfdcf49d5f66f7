// The samplers' references and the oracle, on cases whose answers are known.
#include "projtex/sampler_reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/parse_name.h"
#include "support/cameras.h"

namespace photohull::projtex::reference {
namespace {

using glm::dvec2;
using glm::dvec3;

LinearImage image_of(int size, const std::function<double(int, int)>& value) {
  LinearImage image{size, size, {}};
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) image.pixels.emplace_back(dvec3(value(x, y)), 1.0);
  return image;
}

LinearImage random_image(test::Rng& rng, int size) {
  return image_of(size, [&](int, int) { return test::uniform(rng, 0, 1); });
}

/// Pixel positions are voxel coordinates.
GridCamera flat_camera(int size) {
  GridCamera camera;
  camera.width = camera.height = size;
  return camera;
}

PlaneSquare flat_square(const dvec2& centre, const dvec2& u, const dvec2& v) {
  return {{centre, 1}, {u, 0}, {v, 0}};
}

/// A turned square, `size` the root of its area in pixels, one axis `ratio` times the other.
PlaneSquare turned_square(test::Rng& rng, double size, double ratio, double low, double high) {
  const double a = test::uniform(rng, 0, 6.3), b = test::uniform(rng, 0, 6.3);
  const dvec2 e(std::cos(a), std::sin(a)), n(-e.y, e.x);
  const dvec2 longer = e * size * std::sqrt(ratio), shorter = n * size / std::sqrt(ratio);
  return flat_square({test::uniform(rng, low, high), test::uniform(rng, low, high)},
                     std::cos(b) * longer + std::sin(b) * shorter,
                     std::cos(b) * shorter - std::sin(b) * longer);
}

TEST(IntegratePolygon, UprightRectanglesAreWeightedByPixelAreas) {
  const LinearImage image = image_of(8, [](int x, int y) { return x + 10 * y; });
  const dvec2 box[] = {{1.75, 2.5}, {3.0, 2.5}, {3.0, 4.0}, {1.75, 4.0}};
  // Columns 2 and 3 by 0.75 and 0.5; rows 3 and 4 by 1 and 0.5.
  const double x = (2 * 0.75 + 3 * 0.5) / 1.25, y = (3 * 1 + 4 * 0.5) / 1.5;
  EXPECT_NEAR(integrate_polygon(image, box).r, x + 10 * y, 1e-12);
}

TEST(IntegratePolygon, ATriangleAcrossTheBorderCountsWhatIsOnTheImage) {
  const LinearImage image = image_of(4, [](int, int) { return 1; });
  const dvec2 triangle[] = {{-2.5, -0.5}, {1.5, -0.5}, {-2.5, 3.5}};
  // Area 8; right of the border at -0.5 lies a similar triangle with half the sides.
  EXPECT_NEAR(integrate_polygon(image, triangle).a, 0.25, 1e-12);
}

TEST(IntegratePolygon, PolygonsWithoutAreaGiveAPixel) {
  const LinearImage image = image_of(4, [](int x, int y) { return x + 4 * y; });
  const dvec2 point[] = {{1.2, 2.4}, {1.2, 2.4}, {1.2, 2.4}};
  EXPECT_EQ(integrate_polygon(image, point).r, 9);
  const dvec2 far[] = {{-7, 2}, {-7, 2}, {-7, 2}};
  EXPECT_EQ(integrate_polygon(image, far).a, 0);
}

TEST(IntegratePolygon, AgreesWithManyPointSamples) {
  test::Rng rng(3);
  const LinearImage image = random_image(rng, 32);
  for (int i = 0; i < 10; ++i) {
    const PlaneSquare square = turned_square(rng, 6, 3, 10, 22);
    double sum = 0;
    constexpr int kPoints = 300;
    for (int b = 0; b < kPoints; ++b)
      for (int a = 0; a < kPoints; ++a) {
        const dvec3 p = square.centre + ((a + 0.5) / kPoints - 0.5) * square.u +
                        ((b + 0.5) / kPoints - 0.5) * square.v;
        sum += image.pixels[std::size_t(std::lround(p.y)) * 32 + std::size_t(std::lround(p.x))].r;
      }
    EXPECT_NEAR(oracle(image, flat_camera(32), square).r, sum / kPoints / kPoints, 1e-3);
  }
}

TEST(Footprint, TheJacobianIsTheLimitOfDifferences) {
  test::Rng rng(5);
  const GridSpec grid{{0, 0, 0}, 1, {2, 2, 2}};
  for (int i = 0; i < 50; ++i) {
    const GridCamera camera = to_grid(test::random_camera(rng, grid.bounds(), 640, 480), grid);
    const PlaneSquare square{test::uniform_in(rng, grid.bounds()), test::random_direction(rng),
                             test::random_direction(rng)};
    const Footprint f = footprint_of(camera, square);
    ASSERT_TRUE(f.in_front);
    const auto pixel = [&](const dvec3& point) {
      const dvec3 p = camera.projection * glm::dvec4(point, 1);
      return dvec2(p) / p.z;
    };
    const double h = 1e-4;
    const dvec2 du =
        (pixel(square.centre + h * square.u) - pixel(square.centre - h * square.u)) / (2 * h);
    const dvec2 dv =
        (pixel(square.centre + h * square.v) - pixel(square.centre - h * square.v)) / (2 * h);
    EXPECT_LT(glm::length(du - f.du) + glm::length(dv - f.dv), 1e-6);
    const FootprintAxes axes = axes_of(f);
    EXPECT_NEAR(axes.longer * axes.shorter, std::abs(f.du.x * f.dv.y - f.du.y * f.dv.x), 1e-9);
    EXPECT_NEAR(axes.longer * axes.longer + axes.shorter * axes.shorter,
                glm::dot(f.du, f.du) + glm::dot(f.dv, f.dv), 1e-9);
  }
}

TEST(Footprint, BehindTheCameraThereIsNothing) {
  const GridSpec grid{{0, 0, 0}, 1, {2, 2, 2}};
  const GridCamera camera = to_grid(test::look_at({0, 0, -40}, {0, 0, 0}, 100, 64, 64), grid);
  const PlaneSquare behind{{0, 0, -60}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_FALSE(footprint_of(camera, behind).in_front);
  const auto chain = covered_chain(image_of(64, [](int, int) { return 1; }));
  for (const Sampler sampler : {Sampler::kNearest, Sampler::kTrilinear, Sampler::kEwa})
    EXPECT_EQ(sample_square(sampler, chain, camera, behind, 2).a, 0);
  EXPECT_EQ(oracle(chain[0], camera, behind).a, 0);
}

TEST(Samplers, AnEvenImageIsEvenWhateverTheFootprint) {
  test::Rng rng(7);
  const auto chain = covered_chain(image_of(512, [](int, int) { return 0.3; }));
  for (const Sampler sampler : kSamplers) {
    if (sampler == Sampler::kHardware) continue;
    for (const double size : {0.1, 1.0, 7.0}) {
      const PlaneSquare square = turned_square(rng, size, 5, 200, 300);
      const glm::dvec4 found = sample_square(sampler, chain, flat_camera(512), square, 1);
      EXPECT_NEAR(found.r, 0.3, 1e-9) << to_string(sampler) << ", " << size;
      EXPECT_NEAR(found.a, 1, 1e-9);
    }
  }
}

TEST(Samplers, BilinearIsTheIntegralOverAnUprightPixel) {
  test::Rng rng(9);
  const LinearImage image = random_image(rng, 64);
  const std::vector<LinearImage> chain = covered_chain(image);
  for (int i = 0; i < 20; ++i) {
    const PlaneSquare square =
        flat_square({test::uniform(rng, 10, 50), test::uniform(rng, 10, 50)}, {1, 0}, {0, 1});
    const double expected = oracle(image, flat_camera(64), square).r;
    for (const Sampler sampler : {Sampler::kBilinear, Sampler::kTrilinear, Sampler::kSummedArea})
      EXPECT_NEAR(sample_square(sampler, chain, flat_camera(64), square, 1).r, expected, 1e-9);
  }
}

TEST(Samplers, SummedAreasAreExactForUprightRectangles) {
  test::Rng rng(11);
  const LinearImage image = random_image(rng, 128);
  for (int i = 0; i < 20; ++i) {
    const PlaneSquare square = flat_square({test::uniform(rng, 40, 80), test::uniform(rng, 40, 80)},
                                           {std::exp2(test::uniform(rng, -2, 5)), 0},
                                           {0, std::exp2(test::uniform(rng, -2, 5))});
    const LinearImage chain[] = {image};
    EXPECT_NEAR(sample_square(Sampler::kSummedArea, chain, flat_camera(128), square, 1).r,
                oracle(image, flat_camera(128), square).r, 1e-9);
  }
}

/// Root mean square of the difference to the oracle over turned squares, in percent of full scale.
double error_of(Sampler sampler, int supersample, double size, double ratio,
                const LinearImage& image, std::span<const LinearImage> chain) {
  test::Rng rng(13);
  double sum = 0;
  constexpr int kSquares = 60;
  for (int i = 0; i < kSquares; ++i) {
    const PlaneSquare square = turned_square(rng, size, ratio, 200, 312);
    const double d = sample_square(sampler, chain, flat_camera(512), square, supersample).r -
                     oracle(image, flat_camera(512), square).r;
    sum += d * d;
  }
  return 100 * std::sqrt(sum / kSquares);
}

TEST(Samplers, SupersampledTheyComeWithinAPercentOfTheOracle) {
  test::Rng rng(15);
  const LinearImage noise = random_image(rng, 512);
  const LinearImage zones = image_of(512, [](int x, int y) {
    return 0.5 +
           0.5 * std::cos(std::numbers::pi * (std::pow(x - 256, 2) + std::pow(y - 256, 2)) / 512);
  });
  for (const LinearImage* image : {&noise, &zones}) {
    const std::vector<LinearImage> chain = covered_chain(*image);
    for (const double size : {0.25, 1.0, 4.0, 16.0})
      for (const double ratio : {1.0, 16.0}) {
        EXPECT_LT(error_of(Sampler::kEwa, 4, size, ratio, *image, chain), 1)
            << size << ", " << ratio;
        EXPECT_LT(error_of(Sampler::kAnisotropic, 8, size, ratio, *image, chain), 1)
            << size << ", " << ratio;
        EXPECT_GT(error_of(Sampler::kNearest, 1, size, ratio, *image, chain), 1)
            << size << ", " << ratio;
      }
  }
}

TEST(SamplerNames, AreReadBackAndOthersRefused) {
  for (const Sampler sampler : kSamplers)
    EXPECT_EQ(parse_name("--sampler", to_string(sampler), kSamplers), sampler);
  try {
    parse_name("--sampler", "bicubic", kSamplers);
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("--sampler bicubic"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("ewa"), std::string::npos);
  }
}

}  // namespace
}  // namespace photohull::projtex::reference
