#include "masks/continued_object.h"

#include <cmath>

#include "masks/nearest_pixel.h"

namespace photohull {
namespace {

constexpr int kShown = 2;        // pixels from the border within which the object shows itself
constexpr float kBeyond = 4;     // pixels from it to where the background does
constexpr int kBody = 12;        // pixels to every side of it that tell how wide the object is
constexpr int kTogether = 7;     // pixels to every side that decide together
constexpr double kMostOf = 0.5;  // of them

/// What the object sends beside its border at `at`, where its evidence is strongest.
cv::Vec3f object_at(const cv::Mat& taken, const cv::Mat& distance, const cv::Point& at) {
  const cv::Rect near = cv::Rect(at.x - kShown, at.y - kShown, 2 * kShown + 1, 2 * kShown + 1) &
                        cv::Rect({}, taken.size());
  cv::Point best;
  cv::minMaxLoc(distance(near), nullptr, nullptr, nullptr, &best);
  return taken.at<cv::Vec3f>(best + near.tl());
}

}  // namespace

cv::Mat continued_object(const cv::Mat& taken, const MaskEvidence& evidence, const cv::Mat& hull) {
  const cv::Mat object = evidence.distance >= evidence.strong, asked = hull & ~object;
  if (cv::countNonZero(object) == 0) return cv::Mat::zeros(taken.size(), CV_8U);
  const NearestPixel borders(object);
  cv::Mat smooth, widths;  // widths: between the object's border and its middle
  cv::blur(taken, smooth, {3, 3});
  cv::distanceTransform(object, widths, cv::DIST_L2, cv::DIST_MASK_3);
  cv::dilate(widths, widths, square(kBody));
  const cv::Rect frame({}, taken.size());
  cv::Mat alike(taken.size(), CV_32F, cv::Scalar(0));
  for (int y = 0; y < asked.rows; ++y)
    for (int x = 0; x < asked.cols; ++x) {
      if (!asked.at<std::uint8_t>(y, x)) continue;
      const cv::Point here(x, y), border = borders.of(here);
      // Of thin parts little can be hidden.
      if (borders.distance(here) > widths.at<float>(border)) continue;
      const cv::Point2f away = cv::Point2f(here - border) * (1 / float(cv::norm(here - border)));
      const cv::Point beyond(border + cv::Point(cv::Point2f(kBeyond * away)));
      const bool free = frame.contains(beyond) && !object.at<std::uint8_t>(beyond);
      const cv::Vec3f step =
          object_at(taken, evidence.distance, border) - smooth.at<cv::Vec3f>(free ? beyond : here);
      alike.at<float>(here) =
          std::sqrt(step.dot(step) / 3) / evidence.unit.at<float>(border) < float(evidence.strong);
    }
  cv::Mat agreeing, all;
  const cv::Size window(2 * kTogether + 1, 2 * kTogether + 1);
  cv::boxFilter(alike, agreeing, CV_32F, window);
  cv::boxFilter(asked, all, CV_32F, window);
  return asked & (agreeing > kMostOf / 255 * all);
}

}  // namespace photohull
