// The still background behind a sheet, as a photograph's mask asks for it. Private to module masks:
// includes OpenCV.
#pragma once

#include <opencv2/core.hpp>

#include "masks/mask_evidence.h"
#include "masks/still_background.h"

namespace photohull {

struct Behind {
  cv::Mat light;      ///< CV_32FC3, square roots of linear light
  cv::Mat deviation;  ///< CV_32F, of the same; 0 where nothing is known
  cv::Mat level;      ///< CV_8U, StillBackground::Level

  /// `taken`: the photograph, as light_roots has it, of the same size.
  Behind(const StillBackground& still, const cv::Mat& taken);

  /// Light as the photograph is exposed, by the usual ratio where `free` (CV_8U) is not 0: nothing
  /// stands before the background there.
  void expose_as(const cv::Mat& taken, const cv::Mat& free);
};

/// What a photograph shows where, CV_8U, 255 or 0.
struct SheetParts {
  cv::Mat page, possible, unknown;
};

/// Where doubtful background is not to be believed (255): it is enclosed by the object, or most of
/// the object's strong evidence on the page's rim has no evidence of an object on the other side,
/// so that what is there is the object, which looks alike from all sides.
cv::Mat disbelieved(const Behind& behind, const SheetParts& parts, const MaskEvidence& evidence);

}  // namespace photohull
