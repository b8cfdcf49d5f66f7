// Internal to calib: parts of find_board.
#pragma once

#include <opencv2/core.hpp>

#include "calib/calibrate_board.h"

namespace photohull {

/// Linear light (CV_32F), in which blurred edges lie where sharp ones would; blurred by so many
/// pixels itself.
cv::Mat linear_grey(const ColourImage& image, double blur = 0.8);
/// Luminance as sRGB codes (CV_8U).
cv::Mat grey_bytes(const ColourImage& image);

/// Dots of a grid found roughly (row by row, as board.columns has them): each one's middle becomes
/// the centre of darkness of its cell, in linear light, which is the centroid of the dot's picture
/// however it is blurred. Sets view.points, pixels and dot_radius (the median one, by the area that
/// is dark); without points where dots cannot be told from what is around them.
void measure_dots(const cv::Mat& linear, const std::vector<cv::Point2f>& found,
                  const BoardSpec& board, BoardView& view);

}  // namespace photohull
