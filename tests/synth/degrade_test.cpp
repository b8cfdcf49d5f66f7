#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/box.h"
#include "core/image.h"
#include "synth/degrade_cameras.h"
#include "synth/degrade_image.h"
#include "synth/degrade_mask.h"
#include "synth/place_cameras.h"

namespace photohull::synth {
namespace {

Picture flat(int width, int height, float light) {
  Picture p;
  p.width = width, p.height = height;
  p.colour.assign(std::size_t(width) * height, glm::vec3(light));
  return p;
}

struct Moments {
  double mean = 0, deviation = 0;
};

/// Of one channel, in linear light.
Moments moments(const std::vector<std::uint8_t>& rgb, int channel) {
  double sum = 0, squares = 0;
  for (std::size_t i = std::size_t(channel); i < rgb.size(); i += 3) {
    const double v = linear_from_srgb(rgb[i] / 255.0);
    sum += v, squares += v * v;
  }
  const double n = double(rgb.size() / 3);
  return {sum / n, std::sqrt(squares / n - sum * sum / (n * n))};
}

TEST(Noise, HasTheDeviationAskedFor) {
  DegradationSpec spec;
  spec.read_noise = 0.01, spec.photon_noise = 0.03;
  for (const float light : {0.2f, 0.6f}) {
    const auto rgb = expose(flat(200, 150, light), spec, 5, 0);
    const double expected = std::sqrt(0.01 * 0.01 + 0.03 * 0.03 * light);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(moments(rgb, c).deviation, expected, 0.03 * expected) << light;
      EXPECT_NEAR(moments(rgb, c).mean, light, 0.002);
    }
  }
  EXPECT_NE(expose(flat(20, 20, 0.5f), spec, 5, 0), expose(flat(20, 20, 0.5f), spec, 5, 1));
  EXPECT_NE(expose(flat(20, 20, 0.5f), spec, 5, 0), expose(flat(20, 20, 0.5f), spec, 6, 0));
  EXPECT_EQ(expose(flat(20, 20, 0.5f), spec, 5, 3), expose(flat(20, 20, 0.5f), spec, 5, 3));
}

TEST(Noise, OfTheCodesHasTheDeviationAskedForInCodes) {
  DegradationSpec spec;
  spec.code_noise = 6;
  for (const int code : {60, 190}) {
    const auto rgb = expose(flat(200, 150, float(linear_from_srgb(code / 255.0))), spec, 5, 0);
    double sum = 0, squares = 0;
    for (const std::uint8_t v : rgb) sum += v, squares += double(v) * v;
    const double n = double(rgb.size()), mean = sum / n;
    EXPECT_NEAR(mean, code, 0.1);
    EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 6, 0.15) << code;
  }
}

TEST(Exposure, At16BitsHasThatManyLevels) {
  for (const double encoded : {0.0, 0.1, 0.70001, 1.0}) {
    const auto rgb = expose_16_bits(flat(1, 1, float(linear_from_srgb(encoded))), {}, 1, 0);
    ASSERT_EQ(rgb.size(), 3u);
    EXPECT_NEAR(rgb[1] / 65535.0, encoded, 1.0 / 65535);
  }
}

TEST(Exposure, WithoutDegradationTheCodesAreExact) {
  for (int code = 0; code < 256; ++code) {
    const auto rgb = expose(flat(1, 1, float(linear_from_srgb(code / 255.0))), {}, 1, 0);
    EXPECT_EQ(rgb, std::vector<std::uint8_t>(3, std::uint8_t(code)));
  }
}

TEST(Exposure, GainsSpreadAsAskedFor) {
  DegradationSpec spec;
  spec.exposure = 0.3, spec.white_balance = 0.1;
  double green = 0, red = 0;
  constexpr int kViews = 2000;
  for (int view = 0; view < kViews; ++view) {
    const auto rgb = expose(flat(1, 1, 0.2f), spec, 9, std::size_t(view));
    const double g = std::log2(linear_from_srgb(rgb[1] / 255.0) / 0.2);
    const double r = std::log2(linear_from_srgb(rgb[0] / 255.0) / 0.2) - g;
    green += g * g, red += r * r;
  }
  EXPECT_NEAR(std::sqrt(green / kViews), 0.3, 0.02);
  EXPECT_NEAR(std::sqrt(red / kViews), 0.1, 0.01);
}

TEST(Vignetting, TakesItsShareInTheCorners) {
  DegradationSpec spec;
  spec.vignetting = 0.4;
  const auto rgb = expose(flat(65, 49, 0.5f), spec, 1, 0);
  EXPECT_NEAR(linear_from_srgb(rgb[0] / 255.0), 0.3, 0.004);
  EXPECT_NEAR(linear_from_srgb(rgb[3 * (24 * 65 + 32)] / 255.0), 0.5, 0.004);
}

TEST(Blur, SpreadsAPointAsAGaussian) {
  std::vector<glm::vec3> image(41 * 41, glm::vec3(0));
  image[20 * 41 + 20] = glm::vec3(1);
  blur(image, 41, 41, 1.7);
  double sum = 0, variance = 0;
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) {
      sum += image[std::size_t(y) * 41 + x].g;
      variance += image[std::size_t(y) * 41 + x].g * (x - 20) * (x - 20);
    }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_NEAR(std::sqrt(variance), 1.7, 0.01);
}

TEST(Jpeg, LosesMoreAtLowerQuality) {
  std::vector<std::uint8_t> rgb(64 * 48 * 3);
  for (std::size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = std::uint8_t(128 + 60 * std::sin(0.01 * double(i % 997)) + double(i * 7919 % 31));
  const auto error = [&](int quality) {
    const auto coded = through_jpeg(rgb, 64, 48, quality);
    double sum = 0;
    for (std::size_t i = 0; i < rgb.size(); ++i)
      sum += (double(coded[i]) - rgb[i]) * (double(coded[i]) - rgb[i]);
    return std::sqrt(sum / double(rgb.size()));
  };
  EXPECT_GT(error(95), 0);
  EXPECT_LT(error(95), 20);
  EXPECT_GT(error(10), 1.2 * error(95));
  EXPECT_EQ(through_jpeg(rgb, 64, 48, 50), through_jpeg(rgb, 64, 48, 50));
}

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

class CameraErrors : public testing::Test {
 protected:
  CameraErrors() {
    const Spec spec = parse_spec(R"({"geometry": {"shape": "block"}})", "test", "");
    const Surface surface = make_surface(spec.geometry);
    cameras_ = place_cameras(spec, surface);
    for (std::size_t i = 0; i < surface.mesh.positions.size(); ++i)
      points_.push_back(surface.mesh.world(i));
  }
  std::vector<LensCamera> cameras_;
  std::vector<glm::dvec3> points_;
};

TEST_F(CameraErrors, PosesAreOffByThePixelsAskedFor) {
  for (const double pixels : {0.25, 2.0, 10.0}) {
    DegradationSpec spec;
    spec.pose_error = pixels;
    const auto off = degrade_cameras(cameras_, spec, 3, points_);
    EXPECT_NEAR(reprojection_error(cameras_, off, points_), pixels, 1e-6);
    for (std::size_t i = 0; i < off.size(); ++i) {
      const glm::dmat3 r = off[i].camera.cam_from_world.rotation;
      EXPECT_NEAR(determinant(r), 1, 1e-12);
      EXPECT_EQ(off[i].camera.intrinsics.fx, cameras_[i].camera.intrinsics.fx);
    }
  }
}

TEST_F(CameraErrors, IntrinsicsAreOffByThePixelsAskedForAndAlikeInAllViews) {
  DegradationSpec spec;
  spec.intrinsics_error = 1.5;
  const auto off = degrade_cameras(cameras_, spec, 3, points_);
  EXPECT_NEAR(reprojection_error(cameras_, off, points_), 1.5, 1e-6);
  for (const LensCamera& lens : off) {
    EXPECT_EQ(lens.camera.intrinsics.fx, off[0].camera.intrinsics.fx);
    EXPECT_EQ(lens.camera.intrinsics.cx, off[0].camera.intrinsics.cx);
  }
  EXPECT_EQ(off[5].camera.cam_from_world.translation,
            cameras_[5].camera.cam_from_world.translation);
}

TEST_F(CameraErrors, WrongViewsAreTurnedAboutTheMiddleAndNoOtherView) {
  DegradationSpec spec;
  spec.wrong_views = 0.25, spec.wrong_turn = 40;
  ASSERT_EQ(cameras_.size(), 36u);
  const auto off = degrade_cameras(cameras_, spec, 3, points_);
  Box box{points_.front(), points_.front()};
  for (const glm::dvec3& p : points_) box.min = min(box.min, p), box.max = max(box.max, p);
  int wrong = 0;
  for (std::size_t i = 0; i < off.size(); ++i) {
    const glm::dmat3 turn = transpose(cameras_[i].camera.cam_from_world.rotation) *
                            off[i].camera.cam_from_world.rotation;
    const double degrees = glm::degrees(
        std::acos(std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2, -1.0, 1.0)));
    if (degrees < 1e-3) continue;
    ++wrong;
    EXPECT_NEAR(degrees, 40, 1e-6);
    EXPECT_LT(length(*off[i].project(box.center()) - *cameras_[i].project(box.center())), 1e-6);
  }
  EXPECT_EQ(wrong, 9);
  EXPECT_TRUE(cameras_are_off(spec));
}

TEST_F(CameraErrors, AShareOfTheViewsIsShiftedByThePixelsAskedFor) {
  DegradationSpec spec;
  spec.view_shift = 2;
  EXPECT_FALSE(cameras_are_off(spec));  // no views
  for (const auto& [share, expected] :
       {std::pair{0.0, 0}, {0.001, 1}, {0.25, 9}, {2.0 / 36, 2}, {1.0, 36}}) {
    spec.view_shift_views = share;
    const auto off = degrade_cameras(cameras_, spec, 3, points_);
    int shifted = 0;
    std::vector<glm::dvec2> ways;
    for (std::size_t i = 0; i < off.size(); ++i) {
      EXPECT_EQ(off[i].camera.cam_from_world.translation,
                cameras_[i].camera.cam_from_world.translation);
      const glm::dvec2 way = *off[i].project(points_[0]) - *cameras_[i].project(points_[0]);
      if (length(way) == 0) continue;
      ++shifted;
      ways.push_back(way);
      for (const glm::dvec3& p : points_)
        ASSERT_NEAR(length(*off[i].project(p) - *cameras_[i].project(p)), 2, 1e-9);
    }
    EXPECT_EQ(shifted, expected) << share;
    EXPECT_EQ(cameras_are_off(spec), share > 0);
    if (expected > 1) {
      EXPECT_GT(length(ways[0] - ways[1]), 1e-3);  // each in a direction of its own
    }
  }
}

TEST_F(CameraErrors, PrincipalPointsShiftAndDistortionIsForgotten) {
  for (LensCamera& lens : cameras_) lens.distortion = {DistortionModel::kBrown, {0.1, 0, 0, 0}};
  DegradationSpec spec;
  spec.pixel_shift = {0.5, -2};
  spec.ignore_distortion = true;
  const auto off = degrade_cameras(cameras_, spec, 3, points_);
  for (std::size_t i = 0; i < off.size(); ++i) {
    EXPECT_EQ(off[i].camera.intrinsics.cx, cameras_[i].camera.intrinsics.cx + 0.5);
    EXPECT_EQ(off[i].camera.intrinsics.cy, cameras_[i].camera.intrinsics.cy - 2);
    EXPECT_EQ(off[i].distortion.model, DistortionModel::kNone);
  }
}

TEST_F(CameraErrors, NoneLeavesThemAlone) {
  EXPECT_FALSE(cameras_are_off({}));
  EXPECT_EQ(reprojection_error(cameras_, degrade_cameras(cameras_, {}, 3, points_), points_), 0);
}

TEST(MotionBlur, IsTheMeanAlongALine) {
  std::vector<glm::vec3> image(41 * 41, glm::vec3(0));
  image[20 * 41 + 20] = glm::vec3(1);
  motion_blur(image, 41, 41, 8, 0);  // to the right and left
  float sum = 0;
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) {
      const float v = image[std::size_t(y) * 41 + x].r;
      sum += v;
      if (y != 20 || std::abs(x - 20) > 5) {
        EXPECT_EQ(v, 0) << x << " " << y;
      }
      if (y == 20 && std::abs(x - 20) < 4) {
        EXPECT_NEAR(v, 1.0f / 8.5f, 0.01f);
      }
    }
  EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(MotionBlur, TakesItsShareOfTheViews) {
  DegradationSpec spec;
  int none = 0, quarter = 0;
  for (std::size_t view = 0; view < 40; ++view) none += is_motion_blurred(spec, view);
  spec.motion_blur = 5;
  for (std::size_t view = 0; view < 40; ++view) quarter += is_motion_blurred(spec, view);
  EXPECT_EQ(none, 0);
  EXPECT_EQ(quarter, 10);
}

}  // namespace
}  // namespace photohull::synth
