#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "calib/calibrate_board.h"

namespace photohull {

ColourImage coverage_picture(const std::vector<BoardView>& views, const Calibration& calibration) {
  const Intrinsics& k = calibration.intrinsics;
  cv::Mat counts = cv::Mat::zeros(k.height, k.width, CV_32F);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (calibration.left_out[i]) continue;
    std::vector<cv::Point> points, hull;
    for (const glm::dvec2& p : views[i].pixels)
      points.emplace_back(int(std::lround(p.x)), int(std::lround(p.y)));
    cv::convexHull(points, hull);
    cv::Mat one = cv::Mat::zeros(k.height, k.width, CV_32F);
    cv::fillConvexPoly(one, hull, 1.0);
    counts += one;
  }
  double most = 1;
  cv::minMaxLoc(counts, nullptr, &most);
  ColourImage picture{k.width, k.height, ColourImage::Encoding::kSrgb8, false, {}};
  for (int y = 0; y < k.height; ++y)
    for (int x = 0; x < k.width; ++x) {
      const auto level =
          std::uint8_t(std::lround(255 * counts.at<float>(y, x) / std::max(1.0, most)));
      picture.bytes.insert(picture.bytes.end(), {level, level, level, 255});
    }
  return picture;
}

}  // namespace photohull
