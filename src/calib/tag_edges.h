// Edges of tags to fractions of a pixel. Internal to calib.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <opencv2/core.hpp>
#include <optional>

namespace photohull {

/// Of an edge at either end, which is not measured, for the neighbours' blur is there.
inline constexpr double kTagEdgeMargin = 0.08;

struct MeasuredTag {
  std::array<glm::dvec2, 4> corners;  ///< pixels
  double edge_width = 0;  ///< pixels over which its edges rise from a fifth to four fifths
};

/// A tag's black square near `corners` (clockwise in the picture, none of its cells beyond), with
/// `cells` cells to a side, in a picture of linear light (CV_32F). Nothing where an edge cannot be
/// measured: covered, cut by the frame, too small or not straight.
std::optional<MeasuredTag> measure_tag(const cv::Mat& linear, std::array<glm::dvec2, 4> corners,
                                       int cells);

}  // namespace photohull
