// Objects that look like what stands behind them. Private to module masks: includes OpenCV.
#pragma once

#include <opencv2/core.hpp>

#include "masks/mask_evidence.h"

namespace photohull {

/// Where what looks like the background may as well be the object (CV_8U, 255): all photographs'
/// masks have room for it there (`hull`, CV_8U, 255 or 0), and at the border of what is the object
/// beyond doubt the photograph (`taken`, as light_roots has it) does not change, only what is
/// expected of the background does. A white body that hides the edge of a tag is cut there
/// otherwise, for beside the tag paper is expected. The evidence has its unit.
cv::Mat continued_object(const cv::Mat& taken, const MaskEvidence& evidence, const cv::Mat& hull);

}  // namespace photohull
