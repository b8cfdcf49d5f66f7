// From distances to the background colours to a mask.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "masks/background.h"
#include "masks/background_cells.h"
#include "masks/mask_evidence.h"

namespace photohull {
namespace {

constexpr double kSpeck = 0.002;      ///< groups below this share of all strong pixels are dropped
constexpr double kReach = 0.01;       ///< of the shorter side: how far weak pixels may hang on
constexpr int kFewestWeak = 5;        ///< pixels; fewer weak ones that hang together are noise
constexpr double kHole = 0.015;       ///< of the object: enclosed background up to this is shadow
constexpr double kFullDoubt = 0.005;  ///< from this doubt on gaps are closed at full reach
constexpr double kLeastTrust = 0.25;  ///< share of the reach that is used without any doubt
constexpr int kMixed = 2;             ///< pixels along the contour that mix both sides
/// Share of the brightest distance around at which coverage is full. It lies below 1 because sRGB
/// values are not linear in light and since masks should rather be large.
constexpr double kFullCoverage = 0.7;
constexpr double kHalf = 128;  ///< coverage from which a pixel is the object's

cv::Mat distance_image(const BackgroundModel& model, const ColourImage& image) {
  cv::Mat distance(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y) {
    std::uint8_t* row = distance.ptr(y);
    for_each_cell(image, 0, image.width, y, 1,
                  [&](int x, std::size_t cell) { row[x] = model.distance[cell]; });
  }
  return distance;
}

struct Components {
  cv::Mat selected;  ///< 255 where the component is kept
  cv::Rect bounds;   ///< of what is kept
};

/// Components of a binary picture for which keep(area, box) holds.
template <typename Keep>
Components select_components(const cv::Mat& picture, int connectivity, const Keep& keep) {
  cv::Mat labels, stats, centres;
  const int n =
      cv::connectedComponentsWithStats(picture, labels, stats, centres, connectivity, CV_32S);
  Components result{cv::Mat(picture.size(), CV_8U), {}};
  std::vector<std::uint8_t> value(std::size_t(n), 0);
  for (int i = 1; i < n; ++i) {
    const int* s = stats.ptr<int>(i);
    const cv::Rect box(s[cv::CC_STAT_LEFT], s[cv::CC_STAT_TOP], s[cv::CC_STAT_WIDTH],
                       s[cv::CC_STAT_HEIGHT]);
    if (!keep(s[cv::CC_STAT_AREA], box)) continue;
    value[std::size_t(i)] = 255;
    result.bounds |= box;
  }
  for (int y = 0; y < picture.rows; ++y) {
    const int* label = labels.ptr<int>(y);
    std::uint8_t* row = result.selected.ptr(y);
    for (int x = 0; x < picture.cols; ++x) row[x] = value[std::size_t(label[x])];
  }
  return result;
}

/// The components of `picture` that hold a pixel of `seeds`.
cv::Mat touching(const cv::Mat& picture, const cv::Mat& seeds) {
  cv::Mat labels;
  std::vector<std::uint8_t> value(std::size_t(cv::connectedComponents(picture, labels, 8, CV_32S)),
                                  0);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (seeds.at<std::uint8_t>(y, x)) value[std::size_t(labels.at<int>(y, x))] = 255;
  value[0] = 0;
  cv::Mat out(picture.size(), CV_8U);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      out.at<std::uint8_t>(y, x) = value[std::size_t(labels.at<int>(y, x))];
  return out;
}

/// Background that the object encloses in fewer than `limit` pixels becomes object.
void fill_holes(cv::Mat& object, double limit) {
  object |= select_components(object == 0, 4, [&](int area, const cv::Rect& box) {
              return area < limit && box.x > 0 && box.y > 0 && box.br().x < object.cols &&
                     box.br().y < object.rows;
            }).selected;
}

/// Where the photograph does not tell, coverage tells how likely the object is there: more than a
/// half where gaps were closed without evidence, less than a half where there is some evidence
/// beside the object, at thin tips above all. `whole`: the object, 255 inside.
void tell_doubt(const MaskEvidence& model, const cv::Mat& distance, const cv::Mat& whole,
                cv::Mat& object) {
  cv::Mat inner, outer;
  cv::erode(whole, inner, square(kMixed));
  cv::dilate(whole, outer, square(1));
  const double none = 0.5 * model.weak;
  for (int y = 0; y < object.rows; ++y) {
    const std::uint8_t *own = distance.ptr(y), *deep = inner.ptr(y), *near = outer.ptr(y);
    std::uint8_t* coverage = object.ptr(y);
    for (int x = 0; x < object.cols; ++x) {
      const double evidence =
          std::clamp((own[x] - none) / std::max(model.strong - none, 1.0), 0.0, 1.0);
      if (deep[x])
        coverage[x] = std::uint8_t(std::lround(kHalf + (255 - kHalf) * evidence));
      else if (!near[x])
        coverage[x] = std::uint8_t(std::lround((kHalf - 1) * evidence));
    }
  }
}

}  // namespace

/// Along the contour light of both sides mixes: coverage grows with the distance there.
void soften_contour(const cv::Mat& distance, cv::Mat& object) {
  cv::Mat inner, brightest;
  cv::erode(object, inner, square(kMixed));
  cv::dilate(distance, brightest, square(kMixed + 1));
  for (int y = 0; y < object.rows; ++y) {
    const std::uint8_t *far = brightest.ptr(y), *own = distance.ptr(y), *deep = inner.ptr(y);
    std::uint8_t* coverage = object.ptr(y);
    for (int x = 0; x < object.cols; ++x)
      if (coverage[x] && !deep[x])
        coverage[x] =
            std::uint8_t(std::min(255, 255 * own[x] / std::max(1, int(kFullCoverage * far[x]))));
  }
}

MaskEvidence compare_with_model(const BackgroundModel& model, const ColourImage& image) {
  return {distance_image(model, image), model.weak, model.strong, model.doubt, {}};
}

Mask mask_from_background(const BackgroundModel& model, const ColourImage& image) {
  return mask_from_evidence(compare_with_model(model, image));
}

Mask mask_from_evidence(const MaskEvidence& model) {
  cv::Mat distance = model.distance;
  const int width = distance.cols, height = distance.rows;
  Mask mask{width, height, std::vector<std::uint8_t>(std::size_t(width) * height, 0)};
  const double trust = std::clamp(model.doubt / kFullDoubt, kLeastTrust, 1.0);
  const int reach = std::max(1, int(std::lround(trust * kReach * std::min(width, height))));
  const cv::Mat strong = distance >= model.strong;
  const double least = kSpeck * cv::countNonZero(strong);
  Components parts =
      select_components(strong, 8, [&](int area, const cv::Rect&) { return area > least; });
  if (parts.bounds.empty()) return mask;

  const int margin = 2 * reach + kMixed + 1;
  const cv::Rect box =
      (parts.bounds + cv::Size(2 * margin, 2 * margin) - cv::Point(margin, margin)) &
      cv::Rect({}, distance.size());
  cv::Mat object = parts.selected(box);
  distance = distance(box);
  cv::dilate(object, object, square(reach));
  object &= distance >= model.weak;
  if (!model.bare.empty())  // the background is known to the pixel
    object = parts.selected(box) | select_components(object, 8, [](int area, const cv::Rect&) {
                                     return area >= kFewestWeak;
                                   }).selected;
  const cv::Mat apart = object.clone();
  cv::morphologyEx(object, object, cv::MORPH_CLOSE, square(2 * reach));
  if (!model.bare.empty()) {
    object &= ~model.bare(box) | apart;
    object = touching(object, apart);
  }
  const cv::Mat closed = object.clone();
  fill_holes(object, kHole * trust * trust * cv::countNonZero(object));
  if (!model.bare.empty()) {  // what is wide enough is a hole
    cv::Mat open;
    cv::morphologyEx(model.bare(box), open, cv::MORPH_OPEN, square(1));
    object &= ~open | closed;
  }
  const cv::Mat whole = object.clone();
  soften_contour(distance, object);
  tell_doubt(model, distance, whole, object);
  object.copyTo(cv::Mat(height, width, CV_8U, mask.coverage.data())(box));
  return mask;
}

}  // namespace photohull
