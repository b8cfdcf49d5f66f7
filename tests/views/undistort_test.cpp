// Undistortion against OpenCV and against grids rendered through a lens.
#include "views/undistort.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "support/pictures.h"

namespace photohull {
namespace {

const Distortion kBarrel{DistortionModel::kBrown, {-0.28, 0.09, 0.001, -0.0015, -0.01, 0, 0, 0}};
const Distortion kPincushion{DistortionModel::kBrown, {0.15, 0.02, -0.001, 0.002, 0, 0, 0, 0}};
const Distortion kRational{DistortionModel::kBrown,
                           {0.3, -0.1, 0.0005, 0.001, 0.02, 0.5, -0.05, 0.01}};
const Distortion kFisheye{DistortionModel::kFisheye, {-0.02, 0.006, -0.002, 0.0004, 0, 0, 0, 0}};

Intrinsics intrinsics(double focal) { return {320, 240, focal, 1.02 * focal, 0.7, 163.2, 114.6}; }

glm::dvec2 opencv_distort(const Distortion& d, const glm::dvec2& p) {
  std::vector<cv::Point2d> out;
  if (d.model == DistortionModel::kFisheye) {
    cv::fisheye::distortPoints(std::vector<cv::Point2d>{{p.x, p.y}}, out,
                               cv::Mat::eye(3, 3, CV_64F), cv::Vec4d(d.coefficients.data()));
  } else {
    cv::projectPoints(std::vector<cv::Point3d>{{p.x, p.y, 1}}, cv::Vec3d(), cv::Vec3d(),
                      cv::Mat::eye(3, 3, CV_64F),
                      std::vector<double>(d.coefficients.begin(), d.coefficients.end()), out);
  }
  return {out[0].x, out[0].y};
}

/// Ray that a lens images at p, by fixed-point iteration.
glm::dvec2 ideal_of(const Distortion& d, const glm::dvec2& p) {
  glm::dvec2 guess = p;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 step = 0.7 * (p - distort(d, guess));
    guess += step;
    if (glm::length(step) < 1e-10) break;
  }
  return guess;
}

glm::dvec2 to_pixel(const Intrinsics& k, const glm::dvec2& p) {
  return {k.fx * p.x + k.skew * p.y + k.cx, k.fy * p.y + k.cy};
}

glm::dvec2 to_plane(const Intrinsics& k, const glm::dvec2& p) {
  const double y = (p.y - k.cy) / k.fy;
  return {(p.x - k.cx - k.skew * y) / k.fx, y};
}

/// A view of round dots, 0.125 apart in the image plane, through a lens.
PreparedView photograph_dots(const Intrinsics& k, const Distortion& d) {
  const Paint paint = [&](double u, double v) {
    const glm::dvec2 p = ideal_of(d, to_plane(k, {u, v}));
    const glm::dvec2 cell = p / 0.125 - glm::round(p / 0.125);
    const double radius = glm::length(cell) * 0.125 * k.fx;
    return glm::vec3(float(0.05 + 0.8 * std::exp(-radius * radius / 18)));
  };
  PreparedView view;
  view.camera.intrinsics = k;
  view.image = paint_half(k.width, k.height, paint);
  return view;
}

/// Centre of light of the dot near a position of the picture.
glm::dvec2 dot_near(const ColourImage& image, const glm::dvec2& near) {
  glm::dvec2 sum(0);
  double total = 0;
  for (int y = int(near.y) - 7; y <= int(near.y) + 8; ++y)
    for (int x = int(near.x) - 7; x <= int(near.x) + 8; ++x) {
      const double w = std::max(0.0, double(image.linear(x, y).g) - 0.12);
      sum += w * glm::dvec2(x, y);
      total += w;
    }
  return sum / total;
}

void expect_dots_on_grid(const Intrinsics& k, const Distortion& d, int least_dots) {
  PreparedView view = photograph_dots(k, d);
  undistort(d, 2.0, view);
  const Intrinsics& out = view.camera.intrinsics;
  EXPECT_EQ(out.width, view.image.width);
  EXPECT_EQ(out.height, view.image.height);
  EXPECT_EQ(out.fx, k.fx);
  EXPECT_EQ(out.fy, k.fy);
  int dots = 0;
  for (int j = -12; j <= 12; ++j)
    for (int i = -12; i <= 12; ++i) {
      const glm::dvec2 truth = to_pixel(out, {0.125 * i, 0.125 * j});
      if (truth.x < 9 || truth.y < 9 || truth.x > out.width - 10 || truth.y > out.height - 10)
        continue;
      bool known = true;
      for (const int dy : {-9, 0, 9})
        for (const int dx : {-9, 0, 9})
          known &= view.image.linear(int(truth.x) + dx, int(truth.y) + dy).a == 1;
      if (!known) continue;
      EXPECT_LT(glm::distance(dot_near(view.image, truth), truth), 0.1) << i << "," << j;
      ++dots;
    }
  EXPECT_GE(dots, least_dots);
}

TEST(Undistort, ModelsAgreeWithOpenCv) {
  for (const Distortion& d : {kBarrel, kPincushion, kRational, kFisheye})
    for (double y = -0.6; y <= 0.6; y += 0.15)
      for (double x = -0.7; x <= 0.7; x += 0.14)
        EXPECT_LT(glm::distance(distort(d, {x, y}), opencv_distort(d, {x, y})), 1e-9);
}

TEST(Undistort, BarrelDotsLandOnGrid) { expect_dots_on_grid(intrinsics(260), kBarrel, 45); }
TEST(Undistort, PincushionDotsLandOnGrid) { expect_dots_on_grid(intrinsics(260), kPincushion, 35); }
TEST(Undistort, RationalDotsLandOnGrid) { expect_dots_on_grid(intrinsics(260), kRational, 35); }
TEST(Undistort, FisheyeDotsLandOnGrid) { expect_dots_on_grid(intrinsics(170), kFisheye, 90); }

TEST(Undistort, FrameKeepsEveryPixelOfThePhotograph) {
  for (const Distortion& d : {kBarrel, kPincushion, kRational}) {
    const Intrinsics k = intrinsics(260), out = undistorted_intrinsics(k, d, 4.0);
    for (int i = 0; i <= 40; ++i)
      for (const glm::dvec2 border :
           {glm::dvec2(-0.5 + 8 * i, -0.5), glm::dvec2(-0.5 + 8 * i, 239.5),
            glm::dvec2(-0.5, -0.5 + 6 * i), glm::dvec2(319.5, -0.5 + 6 * i)}) {
        const glm::dvec2 p = to_pixel(out, ideal_of(d, to_plane(k, border)));
        EXPECT_TRUE(Camera{out}.on_image(p)) << p.x << "," << p.y;
      }
  }
}

TEST(Undistort, FrameOfWideFisheyeIsLimited) {
  // 320 pixels of 200 degrees: the picture's border has no pinhole image.
  const Intrinsics k = intrinsics(90);
  const Intrinsics out = undistorted_intrinsics(k, kFisheye, 2.0);
  EXPECT_LE(out.width, 2 * k.width + 3);
  EXPECT_LE(out.height, 2 * k.height + 3);
  EXPECT_GT(out.width, 1.8 * k.width);
}

TEST(Undistort, FoldedModelShowsNothingTwice) {
  // r (1 - 0.6 r^2) turns back at r = 0.745: beyond, everything is unknown.
  const Distortion folding{DistortionModel::kBrown, {-0.6}};
  Intrinsics k{320, 240, 200, 200, 0, 159.5, 119.5};
  PreparedView view;
  view.camera.intrinsics = k;
  view.image = paint_srgb(320, 240, [](double, double) { return glm::vec3(0.5f); });
  undistort(folding, 2.0, view);
  const Intrinsics& out = view.camera.intrinsics;
  for (int v = 0; v < out.height; ++v)
    for (int u = 0; u < out.width; ++u)
      if (glm::length(to_plane(out, {u, v})) > 0.75) {
        ASSERT_EQ(view.image.linear(u, v).a, 0) << u << "," << v;
      }
}

TEST(Undistort, UnknownPixelsAreTransparentAndCovered) {
  PreparedView view;
  view.camera.intrinsics = intrinsics(260);
  view.image = paint_srgb(320, 240, [](double, double) { return glm::vec3(0.25f); });
  view.mask = paint_mask(320, 240, [](double, double) { return 0.0; });
  undistort(kBarrel, 2.0, view);
  EXPECT_TRUE(view.image.has_alpha);
  int unknown = 0;
  for (int y = 0; y < view.image.height; ++y)
    for (int x = 0; x < view.image.width; ++x) {
      const bool known = view.image.linear(x, y).a == 1;
      unknown += !known;
      ASSERT_EQ(view.mask.coverage[std::size_t(y) * view.mask.width + std::size_t(x)],
                known ? 0 : 255);
      ASSERT_NEAR(view.image.linear(x, y).r, known ? 0.25 : 0, 0.003);
    }
  EXPECT_GT(unknown, 100);
}

TEST(Undistort, MaskFollowsTheImage) {
  const Intrinsics k = intrinsics(260);
  const auto shape = [&](double u, double v) {
    const glm::dvec2 p = ideal_of(kBarrel, to_plane(k, {u, v}));
    return 0.5 + (0.2 - glm::length(p - glm::dvec2(0.25, 0.1))) * k.fx;
  };
  PreparedView view;
  view.camera.intrinsics = k;
  view.image = paint_srgb(320, 240, [](double, double) { return glm::vec3(0.25f); });
  view.mask = paint_mask(320, 240, shape);
  undistort(kBarrel, 2.0, view);
  const Intrinsics& out = view.camera.intrinsics;
  for (int v = 0; v < out.height; ++v)
    for (int u = 0; u < out.width; ++u) {
      if (view.image.linear(u, v).a == 0) continue;
      const double d = (0.2 - glm::length(to_plane(out, {u, v}) - glm::dvec2(0.25, 0.1))) * k.fx;
      if (std::abs(d) < 1.5) continue;
      ASSERT_NEAR(view.mask.coverage[std::size_t(v) * out.width + std::size_t(u)], d > 0 ? 255 : 0,
                  2)
          << u << "," << v;
    }
}

TEST(Undistort, ResamplesInLinearLight) {
  // Two-pixel stripes of black and white keep their mean light, not the mean of encoded values.
  PreparedView view;
  view.camera.intrinsics = intrinsics(260);
  view.image = paint_srgb(320, 240,
                          [](double x, double) { return glm::vec3(int(x / 2) % 2 ? 0.9f : 0.1f); });
  undistort(kBarrel, 1.0, view);
  double sum = 0;
  for (int y = 80; y < 160; ++y)
    for (int x = 100; x < 260; ++x) sum += view.image.linear(x, y).g;
  EXPECT_NEAR(sum / (80 * 160), 0.5, 0.01);
}

TEST(Undistort, PointsComeBack) {
  for (const Distortion& d : {kBarrel, kPincushion, kRational, kFisheye})
    for (double y = -0.4; y <= 0.4; y += 0.1)
      for (double x = -0.5; x <= 0.5; x += 0.1) {
        const auto back = undistort_point(d, distort(d, {x, y}));
        ASSERT_TRUE(back);
        EXPECT_LT(glm::distance(*back, {x, y}), 1e-9);
      }
  // r (1 - 0.6 r^2) reaches 0.497 at most.
  EXPECT_FALSE(undistort_point({DistortionModel::kBrown, {-0.6}}, {0.6, 0}));
}

/// What convert --undistort makes of a view.
TEST(Rectify, FrameShowsAllThatThePhotographShows) {
  for (const Distortion& d : {kBarrel, kPincushion, kRational, Distortion{}}) {
    const Intrinsics k = intrinsics(260);
    PreparedView view;
    view.camera.intrinsics = k;
    view.image = paint_srgb(320, 240, [](double, double) { return glm::vec3(0.25f); });
    view.mask = paint_mask(320, 240, [](double, double) { return 0.0; });
    rectify(d, 4.0, view);
    const Intrinsics& out = view.camera.intrinsics;
    // A camera that any format can express, as finely sampled as the finer axis.
    EXPECT_EQ(out.skew, 0);
    EXPECT_EQ(out.fx, out.fy);
    EXPECT_EQ(out.fx, std::max(k.fx, k.fy));
    EXPECT_EQ(out.cx, 0.5 * (out.width - 1));
    EXPECT_EQ(out.cy, 0.5 * (out.height - 1));
    EXPECT_EQ(out.width, view.image.width);
    EXPECT_EQ(out.height, view.mask.height);
    // The photograph's border and what is within are on the frame and known, what is without not.
    int known = 0;
    for (int v = 0; v < out.height; v += 3)
      for (int u = 0; u < out.width; u += 3) {
        const glm::dvec2 source = to_pixel(k, distort(d, to_plane(out, {u, v})));
        const double inside =
            std::min({source.x + 0.5, source.y + 0.5, 319.5 - source.x, 239.5 - source.y});
        const double alpha = view.image.linear(u, v).a;
        if (inside > 1e-6 && glm::length(to_plane(out, {u, v})) < 0.9) {
          ASSERT_EQ(alpha, 1) << u << "," << v;
        }
        if (inside < -1e-6) {
          ASSERT_EQ(alpha, 0) << u << "," << v;
        }
        // Unknown is not background.
        ASSERT_EQ(view.mask.coverage[std::size_t(v) * out.width + std::size_t(u)],
                  alpha == 1 ? 0 : 255);
        known += alpha == 1;
      }
    EXPECT_GT(known, 320 * 240 / 9 * 9 / 10);
    for (int i = 0; i <= 40; ++i)
      for (const glm::dvec2 border : {glm::dvec2(8 * i - 0.5, 0), glm::dvec2(8 * i - 0.5, 239),
                                      glm::dvec2(0, 6 * i - 0.5), glm::dvec2(319, 6 * i - 0.5)})
        EXPECT_TRUE(Camera{out}.on_image(to_pixel(out, ideal_of(d, to_plane(k, border)))));
  }
}

TEST(Rectify, KeepsFineDetail) {
  // Stripes of four pixels keep most of their contrast where the picture is resampled once.
  const Intrinsics k = intrinsics(260);
  PreparedView view;
  view.camera.intrinsics = k;
  view.image = paint_half(320, 240, [](double x, double) {
    return glm::vec3(float(0.5 + 0.4 * std::sin(x * 1.5707963)));
  });
  rectify(kBarrel, 2.0, view);
  double low = 1, high = 0;
  const Intrinsics& out = view.camera.intrinsics;
  for (int x = out.width / 2 - 20; x < out.width / 2 + 20; ++x) {
    const double value = view.image.linear(x, out.height / 2).g;
    low = std::min(low, value), high = std::max(high, value);
  }
  EXPECT_GT(high - low, 0.7);
}

TEST(Rectify, LeavesCentredSquarePinholesAlone) {
  PreparedView view;
  view.camera.intrinsics = {320, 240, 260, 260, 0, 159.5, 119.5};
  view.image = paint_srgb(320, 240, [](double x, double) { return glm::vec3(float(x / 320)); });
  const std::uint8_t* bytes = view.image.bytes.data();
  rectify({}, 2.0, view);
  EXPECT_EQ(view.image.bytes.data(), bytes);
}

TEST(Undistort, LeavesIdealViewsAlone) {
  PreparedView view;
  view.camera.intrinsics = intrinsics(260);
  view.image = paint_srgb(320, 240, [](double x, double) { return glm::vec3(float(x / 320)); });
  const std::uint8_t* bytes = view.image.bytes.data();
  undistort({}, 2.0, view);
  undistort({DistortionModel::kBrown, {}}, 2.0, view);
  EXPECT_EQ(view.image.bytes.data(), bytes);
  EXPECT_EQ(view.camera.intrinsics.width, 320);
}

}  // namespace
}  // namespace photohull
