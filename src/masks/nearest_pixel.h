// The nearest of some pixels. Private to module masks: includes OpenCV.
#pragma once

#include <opencv2/imgproc.hpp>
#include <vector>

namespace photohull {

/// For each pixel of a picture, which of `source` (CV_8U, not 0; one pixel at least) is nearest.
class NearestPixel {
 public:
  explicit NearestPixel(const cv::Mat& source)
      : places_(std::size_t(cv::countNonZero(source)) + 1) {
    cv::distanceTransform(source == 0, lengths_, labels_, cv::DIST_L2, cv::DIST_MASK_5,
                          cv::DIST_LABEL_PIXEL);
    for (int y = 0; y < source.rows; ++y)
      for (int x = 0; x < source.cols; ++x)
        if (source.at<std::uint8_t>(y, x)) places_[std::size_t(labels_.at<int>(y, x))] = {x, y};
  }

  cv::Point of(const cv::Point& at) const { return places_[std::size_t(labels_.at<int>(at))]; }
  float distance(const cv::Point& at) const { return lengths_.at<float>(at); }  ///< pixels

 private:
  cv::Mat lengths_, labels_;
  std::vector<cv::Point> places_;  ///< by their labels, from 1 on
};

}  // namespace photohull
