// SIFT features of a view [Lowe04]. Internal to cameras; only for files that know OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/prepared_view.h"
#include "photo/align_patch.h"

namespace photohull {

struct Features {
  std::vector<glm::dvec2> pixels;
  cv::Mat descriptors;  ///< a row each
  GreyImage grey;       ///< smoothed a little, for align_patch
  int times = 1;        ///< how many times smaller the image was that they were found in
};

enum class FeatureSearch {
  kFull,
  kQuick,  ///< in an image of half the size, where that has 200 or more
  kCoarse  ///< in an image of about 400 pixels, however few that has
};

/// The `count` strongest features, on the object where the view has a mask. Of large objects,
/// beyond 1600 pixels, in an image that is smaller: places are refined in the image itself
/// (align_patch).
Features detect_features(const PreparedView& view, int count, FeatureSearch search);

}  // namespace photohull
