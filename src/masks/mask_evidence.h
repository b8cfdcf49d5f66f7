// How much a photograph's pixels differ from its background, and masks from that. Private to
// module masks: includes OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/image.h"
#include "masks/background.h"

namespace photohull {

/// What OpenCV's morphology takes: a square of 2 reach + 1 pixels along each side.
inline cv::Mat square(int reach) {
  const int side = 2 * reach + 1;
  return cv::getStructuringElement(cv::MORPH_RECT, {side, side});
}

/// Distances from the background and what they mean, as BackgroundModel has them.
struct MaskEvidence {
  cv::Mat distance;  ///< CV_8U
  int weak = 0;      ///< near strong pixels, the object reaches down to here
  int strong = 0;    ///< from here on a pixel is the object's beyond doubt
  double doubt = 0;  ///< [0, 1]: share of the object's pixels between weak and strong
  /// CV_32F: the difference of light roots that is 1 of distance; empty where colours are compared.
  cv::Mat unit;
  /// CV_8U, 255 where the background is seen beyond doubt: gaps are not closed over it. Empty:
  /// nowhere.
  cv::Mat bare;
};

/// By the colours of the background.
MaskEvidence compare_with_model(const BackgroundModel& model, const ColourImage& image);

/// The object, rather too large than too small (mask_from_background says how).
Mask mask_from_evidence(const MaskEvidence& evidence);

/// Coverage along the contour of a binary object (CV_8U, 255 inside), in place.
void soften_contour(const cv::Mat& distance, cv::Mat& object);

/// What differs from a photograph of the same view without the object: noise is measured along the
/// frame, where there is little of the object; exposure may differ; what is darker but has the
/// plate's hue and texture may be shadow, and counts as weak at most. Distances are four times the
/// deviations of the noise. Both images have the same size.
MaskEvidence compare_with_plate(const ColourImage& image, const ColourImage& plate);

/// Square roots of linear light (CV_32FC3), in which noise is about even.
cv::Mat light_roots(const ColourImage& image);

/// The same comparison by what is expected of each pixel (both as light_roots has it). Noise is
/// measured where `certain` (CV_8U) is not 0: there nothing stands before the background. Where a
/// place that may be shadow is smooth, the shadow's edge may lie up to `edge` pixels from it.
/// `least` (CV_32F): deviation that each pixel has at least; empty: none. `shaded` (CV_8U): where
/// it is not 0, what is expected has its shadow, and there is no other; empty: nowhere.
MaskEvidence compare_with_expected(const cv::Mat& taken, const cv::Mat& expected,
                                   const cv::Mat& certain, int edge, const cv::Mat& least = {},
                                   const cv::Mat& shaded = {});

/// Moves the contour to where OpenCV's GrabCut [Rother04] puts it between what surely is the
/// object and surely is not. Pixels of strong evidence stay the object's. The mask stays as it is
/// where it has nothing certain on either side.
Mask cut_band(const MaskEvidence& evidence, const ColourImage& image, const Mask& mask);

/// Where GrabCut [Rother04] puts background (CV_8U, 255) of what is `unknown` (255), by the colours
/// of strong evidence and those of `background` (255: surely it), which is not all that is not the
/// object; what may as well be the object's is not. Nowhere, where a side has too few pixels to
/// learn from, or more than four million were to be cut.
cv::Mat background_by_colours(const MaskEvidence& evidence, const ColourImage& image,
                              const cv::Mat& unknown, const cv::Mat& background);

/// How sure a mask is, [0, 1]: the share of its contour with clear object on one side and clear
/// background on the other, times how much of it is not in doubt, times its overlap (intersection
/// over union) with `other`, a mask found in another way, where there is one.
double mask_confidence(const MaskEvidence& evidence, const Mask& mask, const Mask* other);

}  // namespace photohull
