// Based on: C. Rother, V. Kolmogorov, A. Blake, "GrabCut: interactive foreground extraction using
// iterated graph cuts", SIGGRAPH 2004 [Rother04], as OpenCV has it.
#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "masks/mask_evidence.h"

namespace photohull {
namespace {

constexpr double kBand = 0.012;  // of the shorter side: how far the contour may move
constexpr int kIterations = 2;
constexpr double kContext = 3;       // bands of surroundings that the colours are learnt from
constexpr double kMostPixels = 4e6;  // beyond, the cut takes minutes
constexpr int kFewestCertain = 400;

cv::Mat square(int radius) {
  return cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1});
}

/// 8-bit sRGB.
cv::Mat coded(const ColourImage& image, const cv::Rect& box) {
  cv::Mat out(box.size(), CV_8UC3);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      cv::Vec3b& p = out.at<cv::Vec3b>(y, x);
      if (image.encoding == ColourImage::Encoding::kSrgb8) {
        const std::uint8_t* bytes =
            &image.bytes[4 * (std::size_t(y + box.y) * std::size_t(image.width) +
                              std::size_t(x + box.x))];
        p = {bytes[0], bytes[1], bytes[2]};
      } else {
        const glm::vec4 c = image.linear(x + box.x, y + box.y);
        for (int k = 0; k < 3; ++k)
          p[k] = std::uint8_t(
              std::lround(255 * srgb_from_linear(double(std::clamp(c[k], 0.0f, 1.0f)))));
      }
    }
  return out;
}

/// Decides the probable labels. The colours of both sides are learnt at half the resolution, which
/// takes a fourth of the time and knows them as well.
void cut(const cv::Mat& colours, cv::Mat& labels) {
  cv::Mat few, few_labels, behind, front;
  cv::resize(colours, few, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::resize(labels, few_labels, few.size(), 0, 0, cv::INTER_NEAREST);
  cv::setRNGSeed(1);  // its clusters start at random
  cv::grabCut(few, few_labels, {}, behind, front, kIterations, cv::GC_INIT_WITH_MASK);
  cv::grabCut(colours, labels, {}, behind, front, 1, cv::GC_EVAL_FREEZE_MODEL);
}

}  // namespace

Mask cut_band(const MaskEvidence& evidence, const ColourImage& image, const Mask& mask) {
  const cv::Mat coverage(mask.height, mask.width, CV_8U,
                         const_cast<std::uint8_t*>(mask.coverage.data()));
  const cv::Mat whole = coverage >= 128;
  cv::Rect box = cv::boundingRect(whole);
  if (box.empty()) return mask;
  const int band = std::max(2, int(std::lround(kBand * std::min(mask.width, mask.height))));
  const int margin = int(kContext * band);
  box = (box + cv::Size(2 * margin, 2 * margin) - cv::Point(margin, margin)) &
        cv::Rect({}, whole.size());
  if (box.area() > kMostPixels) return mask;
  const cv::Mat object = whole(box), distance = evidence.distance(box);
  cv::Mat inner, outer;
  cv::erode(object, inner, square(band));
  cv::dilate(object, outer, square(band));
  const cv::Mat strong = distance >= evidence.strong, weak = distance >= evidence.weak;
  cv::Mat labels(box.size(), CV_8U, cv::Scalar(cv::GC_BGD));
  labels.setTo(cv::GC_PR_BGD, outer & weak);
  labels.setTo(cv::GC_PR_FGD, object);
  labels.setTo(cv::GC_FGD, inner | (object & strong));
  if (cv::countNonZero(labels == cv::GC_FGD) < kFewestCertain ||
      cv::countNonZero(labels == cv::GC_BGD) < kFewestCertain)
    return mask;
  cut(coded(image, box), labels);
  cv::Mat inside = (labels == cv::GC_FGD) | (labels == cv::GC_PR_FGD);
  soften_contour(distance, inside);
  Mask out{mask.width, mask.height, std::vector<std::uint8_t>(mask.coverage.size(), 0)};
  inside.copyTo(cv::Mat(mask.height, mask.width, CV_8U, out.coverage.data())(box));
  return out;
}

double mask_confidence(const MaskEvidence& evidence, const Mask& mask, const Mask* other) {
  const cv::Mat coverage(mask.height, mask.width, CV_8U,
                         const_cast<std::uint8_t*>(mask.coverage.data()));
  const cv::Mat object = coverage >= 128;
  const double area = cv::countNonZero(object);
  if (area == 0 || area == double(object.total())) return 0;
  constexpr int kNear = 2;
  cv::Mat inner, outer, brightest, darkest;
  cv::erode(object, inner, square(1));
  cv::dilate(object, outer, square(1));
  const cv::Mat rim = object & ~inner;
  cv::dilate(evidence.distance & object, brightest, square(kNear));
  cv::Mat outside = evidence.distance.clone();
  outside.setTo(255, object);
  cv::erode(outside, darkest, square(kNear));
  // A contour along the frame of the picture says nothing.
  cv::Mat known(rim.size(), CV_8U, cv::Scalar(0));
  known(cv::Rect(1, 1, rim.cols - 2, rim.rows - 2)).setTo(255);
  const cv::Mat judged = rim & known;
  const double length = std::max(1, cv::countNonZero(judged));
  const cv::Mat above = brightest >= evidence.strong, below = darkest < evidence.weak;
  const double clear = cv::countNonZero(judged & above & below) / length;
  const cv::Mat uncertain = object & (evidence.distance < evidence.strong);
  double confidence = clear * (1 - cv::countNonZero(uncertain & inner) / area);
  if (other && !other->empty()) {
    const cv::Mat second = cv::Mat(mask.height, mask.width, CV_8U,
                                   const_cast<std::uint8_t*>(other->coverage.data())) >= 128;
    const double both = cv::countNonZero(object & second);
    confidence *= both / std::max(1, cv::countNonZero(object | second));
  }
  return std::clamp(confidence, 0.0, 1.0);
}

}  // namespace photohull
