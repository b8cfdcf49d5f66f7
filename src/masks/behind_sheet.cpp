#include "masks/behind_sheet.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/median.h"

namespace photohull {
namespace {

constexpr int kRimDepth = 5, kAcross = 8;  // pixels
constexpr int kRimMixed = 3;               // pixels beside the page that may show a part of it
constexpr int kFewestAtRim = 20;           // pixels
constexpr double kMostLost = 0.5;          // of the pixels at the rim
constexpr float kLeastLight = 0.08f;       // square root; darker tells no exposure

cv::Mat box(int reach) {
  return cv::getStructuringElement(cv::MORPH_RECT, {2 * reach + 1, 2 * reach + 1});
}

/// Doubtful pixels of open background that no background hangs together with that is sure.
cv::Mat enclosed(const cv::Mat& open, const cv::Mat& sure, const cv::Mat& doubtful) {
  cv::Mat labels;
  const int count = cv::connectedComponents(open, labels, 4, CV_32S);
  std::vector<bool> reaches(std::size_t(count), false);
  for (int y = 0; y < open.rows; ++y)
    for (int x = 0; x < open.cols; ++x)
      if (sure.at<std::uint8_t>(y, x)) reaches[std::size_t(labels.at<int>(y, x))] = true;
  cv::Mat out(open.size(), CV_8U, cv::Scalar(0));
  for (int y = 0; y < open.rows; ++y)
    for (int x = 0; x < open.cols; ++x)
      if (open.at<std::uint8_t>(y, x) && doubtful.at<std::uint8_t>(y, x) &&
          !reaches[std::size_t(labels.at<int>(y, x))])
        out.at<std::uint8_t>(y, x) = 255;
  return out;
}

}  // namespace

Behind::Behind(const StillBackground& still, const cv::Mat& taken)
    : light(taken.size(), CV_32FC3), deviation(taken.size(), CV_32F), level(taken.size(), CV_8U) {
  for (int y = 0; y < taken.rows; ++y)
    for (int x = 0; x < taken.cols; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(taken.cols) + std::size_t(x);
      level.at<std::uint8_t>(y, x) = still.level[i];
      deviation.at<float>(y, x) = float(still.deviation[i]) / 1000;
      for (int c = 0; c < 3; ++c)
        light.at<cv::Vec3f>(y, x)[c] = float(still.light[3 * i + std::size_t(c)]) / 65535;
    }
}

void Behind::expose_as(const cv::Mat& taken, const cv::Mat& free) {
  cv::Mat smooth_taken, smooth_light;
  cv::blur(taken, smooth_taken, {5, 5});
  cv::blur(light, smooth_light, {5, 5});
  cv::Mat inside;
  cv::erode(free & (level == StillBackground::kSure), inside, box(2));
  cv::Scalar gain(1, 1, 1);
  const int step = 1 + int(std::sqrt(double(cv::countNonZero(inside)) / 50000));
  for (int c = 0; c < 3; ++c) {
    std::vector<double> ratios;
    for (int y = 0; y < taken.rows; y += step)
      for (int x = 0; x < taken.cols; x += step) {
        const float p = smooth_light.at<cv::Vec3f>(y, x)[c];
        if (inside.at<std::uint8_t>(y, x) && p > kLeastLight)
          ratios.push_back(double(smooth_taken.at<cv::Vec3f>(y, x)[c] / p));
      }
    if (ratios.size() >= 50) gain[c] = std::clamp(median(std::move(ratios)), 0.5, 2.0);
  }
  cv::multiply(light, gain, light);
}

cv::Mat disbelieved(const Behind& behind, const SheetParts& parts, const MaskEvidence& evidence) {
  const cv::Mat beside = ~parts.page, asked = beside & parts.possible;
  const cv::Mat doubtful = asked & (behind.level == StillBackground::kDoubtful) & ~parts.unknown;
  if (cv::countNonZero(doubtful) == 0) return doubtful;
  const cv::Mat open = beside & ~parts.unknown & (evidence.distance < evidence.weak);
  const cv::Mat sure = open & ~doubtful;
  cv::Mat inner, near, found, rim_beside;
  cv::dilate(parts.page, rim_beside, box(kRimMixed));
  cv::dilate(beside, inner, box(kRimDepth));
  cv::dilate(doubtful, near, box(kRimDepth + 1));
  cv::dilate(~rim_beside & (parts.unknown | (evidence.distance >= evidence.strong)), found,
             box(kAcross));
  const cv::Mat rim = parts.page & inner & near & (evidence.distance >= evidence.strong);
  const int there = cv::countNonZero(rim), lost = cv::countNonZero(rim & ~found);
  if (there >= kFewestAtRim && lost > kMostLost * there) return doubtful;
  return enclosed(open, sure, doubtful);
}

}  // namespace photohull
