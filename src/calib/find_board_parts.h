// Internal to calib: parts of find_board.
#pragma once

#include <opencv2/core.hpp>

#include "calib/calibrate_board.h"

namespace photohull {

/// Dots of a grid found roughly (row by row, as board.columns has them): each one's middle becomes
/// the centre of darkness of its cell, in linear light, which is the centroid of the dot's picture
/// however it is blurred. Sets view.points, pixels and dot_radius (the median one, by the area that
/// is dark); without points where dots cannot be told from what is around them.
void measure_dots(const cv::Mat& linear, const std::vector<cv::Point2f>& found,
                  const BoardSpec& board, BoardView& view);

}  // namespace photohull
