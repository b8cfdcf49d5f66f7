// Private to the pictures of boxes and of coverage: drawing by OpenCV, in BGR.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "cameras/scene_points.h"
#include "core/scene.h"

namespace photohull::pipeline::picture {

inline constexpr int kPanelWidth = 900, kPanelHeight = 700;  // pixels, title included
inline constexpr int kTitle = 30;                            // pixels
inline const cv::Scalar kPaper(24, 24, 24), kInk(235, 235, 235), kDim(150, 150, 150),
    kBoxEdge(0, 220, 255);
inline const std::array<cv::Scalar, 3> kAxis{cv::Scalar(70, 70, 255), cv::Scalar(80, 220, 80),
                                             cv::Scalar(255, 150, 60)};

/// Text on a dark ground, its left end and middle at `at`, moved into the picture.
void put_text(cv::Mat& picture, const std::string& text, cv::Point at, double size = 0.45,
              const cv::Scalar& colour = kInk);
/// Width and height of the ground that put_text draws.
cv::Size text_size(const std::string& text, double size = 0.45);

/// Four significant digits at most.
std::string number(double value);

/// Corner i: bit 0 the upper x, bit 1 the upper y, bit 2 the upper z.
glm::dvec3 corner(const Box& box, int i);

/// kPanelWidth x kPanelHeight.
cv::Mat draw_plan(const Scene& scene, std::span<const ScenePoint> points);

}  // namespace photohull::pipeline::picture
