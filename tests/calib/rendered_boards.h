// Boards rendered by rays through a known camera, from pictures of their patterns.
#pragma once

#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <opencv2/aruco/charuco.hpp>

#include "calib/calibrate_board.h"
#include "core/error.h"
#include "support/pictures.h"
#include "views/undistort.h"

namespace photohull {

inline constexpr double kRadian = std::numbers::pi / 180;

/// Brightness of a board at a place in its plane.
using Pattern = std::function<double(double x, double y)>;

/// Squares of side 1 with the first inner corner at (0, 0), a white rim around columns + 1 by
/// rows + 1 of them.
inline Pattern chess(int columns, int rows) {
  return [=](double x, double y) {
    if (x < -1 || y < -1 || x > columns || y > rows) return 0.9;
    return (int(std::floor(x)) + int(std::floor(y))) & 1 ? 0.05 : 0.9;
  };
}

inline Pattern dots(int columns, int rows) {
  return [=](double x, double y) {
    const double i = std::clamp(std::round(x), 0.0, columns - 1.0);
    const double j = std::clamp(std::round(y), 0.0, rows - 1.0);
    return std::hypot(x - i, y - j) < 0.28 ? 0.05 : 0.9;
  };
}

/// OpenCV's drawing, a hundred pixels a square; its corner 0 is at (1, 1).
inline Pattern charuco(int columns, int rows) {
  constexpr int kSquare = 100;
  const auto board = cv::aruco::CharucoBoard::create(columns, rows, 1.0f, 0.75f,
                                                     cv::aruco::getPredefinedDictionary(0));
  cv::Mat drawn;
  board->draw({columns * kSquare, rows * kSquare}, drawn, 0);
  return [=](double x, double y) {
    const int i = int(std::floor(x * kSquare)), j = int(std::floor(y * kSquare));
    if (i < 0 || j < 0 || i >= drawn.cols || j >= drawn.rows) return 0.9;
    return drawn.at<std::uint8_t>(j, i) > 127 ? 0.9 : 0.05;
  };
}

struct Truth {
  Intrinsics k{640, 480, 612.5, 608.0, 0, 326.4, 231.7};
  Distortion lens{DistortionModel::kBrown, {-0.12, 0.05, 0.001, -0.0008, 0, 0, 0, 0}};
};

/// The rays that a lens images at pixel corners, by inverting calib's own distort().
inline std::vector<glm::dvec2> corner_rays(const Truth& truth) {
  std::vector<glm::dvec2> rays;
  for (int y = 0; y <= truth.k.height; ++y)
    for (int x = 0; x <= truth.k.width; ++x) {
      const glm::dvec2 target((x - 0.5 - truth.k.cx) / truth.k.fx,
                              (y - 0.5 - truth.k.cy) / truth.k.fy);
      glm::dvec2 q = target;
      for (int step = 0; step < 12; ++step) q += target - distort(truth.lens, q);
      rays.push_back(q);
    }
  return rays;
}

inline ColourImage photograph(const Truth& truth, const Pose& cam_from_board,
                              const Pattern& pattern) {
  const glm::dmat3 back = glm::transpose(cam_from_board.rotation);
  const glm::dvec3 center = -(back * cam_from_board.translation);
  constexpr int kSamples = 4;
  static Truth known;
  static std::vector<glm::dvec2> rays = corner_rays(known);
  if (known.lens.coefficients != truth.lens.coefficients || known.k.k() != truth.k.k()) {
    known = truth;
    rays = corner_rays(known);
  }
  return paint_srgb(truth.k.width, truth.k.height, [&](double x, double y) {
    const glm::dvec2* r = &rays[std::size_t(y) * (truth.k.width + 1) + std::size_t(x)];
    const auto sample = [&](int i, int j) {
      const double s = (i + 0.5) / kSamples, t = (j + 0.5) / kSamples;
      const glm::dvec2 q = glm::mix(glm::mix(r[0], r[1], s),
                                    glm::mix(r[truth.k.width + 1], r[truth.k.width + 2], s), t);
      const glm::dvec3 d = back * glm::dvec3(q, 1);
      const glm::dvec3 p = center - d * (center.z / d.z);
      return pattern(p.x, p.y);
    };
    // Patterns are larger than pixels: equal corners are a pixel of one colour.
    constexpr int kLast = kSamples - 1;
    const double first = sample(0, 0);
    if (first == sample(kLast, 0) && first == sample(0, kLast) && first == sample(kLast, kLast))
      return glm::vec3(float(first));
    double sum = 0;
    for (int i = 0; i < kSamples * kSamples; ++i) sum += sample(i % kSamples, i / kSamples);
    return glm::vec3(float(sum / (kSamples * kSamples)));
  });
}

/// The board's middle before the camera, tilted in a different way in each of the views.
inline Pose pose_of(int view, const glm::dvec2& middle, double distance) {
  const double tilt = 22 + 6 * (view % 3), towards = 137.5 * view;
  const glm::dvec3 axis(std::cos(towards * kRadian), std::sin(towards * kRadian), 0);
  const glm::dquat q = glm::angleAxis(tilt * kRadian, axis) *
                       glm::angleAxis(10 * kRadian * (view % 5 - 2), glm::dvec3(0, 0, 1));
  Pose pose;
  pose.rotation = glm::mat3_cast(q);
  const glm::dvec3 aim(0.12 * distance * (view % 3 - 1), 0.08 * distance * (view % 4 - 1.5),
                       distance);
  pose.translation = aim - pose.rotation * glm::dvec3(middle, 0);
  return pose;
}

inline std::vector<BoardView> photographs(const Truth& truth, const BoardSpec& spec,
                                          const Pattern& pattern, const glm::dvec2& middle,
                                          int count, double distance) {
  std::vector<BoardView> views;
  for (int i = 0; i < count; ++i)
    views.push_back(find_board(photograph(truth, pose_of(i, middle, distance), pattern), spec,
                               concat("view ", i)));
  return views;
}

/// Views whose pixels are computed, not detected.
inline std::vector<BoardView> exact_views(const Truth& truth, const std::vector<Pose>& poses) {
  std::vector<BoardView> views;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    BoardView view{concat("view ", n), truth.k.width, truth.k.height, {}, {}, 0};
    for (int i = 0; i < 54; ++i) {
      const glm::dvec3 point(i % 9, i / 9, 0);
      const glm::dvec3 p = poses[n].rotation * point + poses[n].translation;
      const glm::dvec2 q = distort(truth.lens, glm::dvec2(p) / p.z);
      view.points.push_back(point);
      view.pixels.emplace_back(truth.k.fx * q.x + truth.k.cx, truth.k.fy * q.y + truth.k.cy);
    }
    views.push_back(view);
  }
  return views;
}

}  // namespace photohull
