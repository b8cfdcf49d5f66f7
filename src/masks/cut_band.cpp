// Based on: C. Rother, V. Kolmogorov, A. Blake, "GrabCut: interactive foreground extraction using
// iterated graph cuts", SIGGRAPH 2004 [Rother04], as OpenCV has it.
#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/imgproc/detail/gcgraph.hpp>
#include <vector>

#include "core/error.h"
#include "masks/mask_evidence.h"

namespace photohull {
namespace {

constexpr double kBand = 0.012;  // of the shorter side: how far the contour may move
constexpr int kIterations = 2;
constexpr double kContext = 3;       // bands of surroundings that the colours are learnt from
constexpr double kMostPixels = 4e6;  // beyond, the cut takes minutes
constexpr int kFewestCertain = 100;
constexpr double kLearnt = 20000;  // pixels that colours are learnt from
// Of the background where nothing but colours tells. Of 0, 3, 8, 20, 50 and 100 this one lets masks
// on turntables have the largest overlap with the exact ones in all (`bench sheet_masks --case
// turntable`): below, grey bodies are cut before a grey background; above, masks are too large.
constexpr double kLead = 20;

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

/// Gaussians of one side's colours, as cv::grabCut learns them: shares, means, covariances.
class Mixture {
 public:
  explicit Mixture(const cv::Mat& model) {
    const double* share = model.ptr<double>();
    const double *mean = share + kParts, *covariance = mean + 3 * kParts;
    for (int i = 0; i < kParts; ++i) {
      const cv::Matx33d matrix(covariance + 9 * i);
      const double determinant = cv::determinant(matrix);
      if (!(share[i] > 0) || !(determinant > 0)) continue;
      parts_.push_back({share[i] / std::sqrt(determinant), cv::Vec3d(mean + 3 * i), matrix.inv()});
    }
  }

  /// Negative logarithm of the density, but for a constant.
  double cost(const cv::Vec3b& colour) const {
    double density = 0;
    for (const Part& p : parts_) {
      const cv::Vec3d d = cv::Vec3d(colour) - p.mean;
      density += p.scale * std::exp(-0.5 * d.dot(p.inverse * d));
    }
    return -std::log(std::max(density, 1e-300));
  }

 private:
  static constexpr int kParts = 5;
  struct Part {
    double scale;
    cv::Vec3d mean;
    cv::Matx33d inverse;
  };
  std::vector<Part> parts_;
};

double squared_difference(const cv::Vec3b& a, const cv::Vec3b& b) {
  const cv::Vec3d d = cv::Vec3d(a) - cv::Vec3d(b);
  return d.dot(d);
}

const cv::Point kNeighbours[] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1},
                                 {1, 0},  {1, 1},   {0, 1},  {-1, 1}};
constexpr int kBefore = 4;  // of them come before a pixel in reading order

/// [Rother04]'s beta: one over twice the mean squared difference of neighbours.
double contrast(const cv::Mat& colours) {
  double sum = 0, count = 0;
  for (int y = 1; y < colours.rows; ++y)
    for (int x = 1; x < colours.cols; ++x) {
      const cv::Vec3b& here = colours.at<cv::Vec3b>(y, x);
      sum += squared_difference(here, colours.at<cv::Vec3b>(y, x - 1)) +
             squared_difference(here, colours.at<cv::Vec3b>(y - 1, x));
      count += 2;
    }
  return sum > 0 ? count / (2 * sum) : 0;
}

/// The cut through the probable pixels alone, which are few: their neighbours of certain labels
/// bind them to source or sink, which gives the same cut as the graph of all pixels.
class BandGraph {
 public:
  /// `lead`: natural logarithm of how many times more likely a colour has to be the background's
  /// than the object's.
  BandGraph(const cv::Mat& colours, const cv::Mat& labels, double lead)
      : colours_(colours),
        labels_(labels),
        beta_(contrast(colours)),
        lead_(lead),
        nodes_(labels.size(), -1) {}

  /// Decides the probable labels.
  cv::Mat cut(const Mixture& behind, const Mixture& front) {
    const int probable = cv::countNonZero((labels_ == cv::GC_PR_BGD) | (labels_ == cv::GC_PR_FGD));
    if (probable < 2) return labels_.clone();
    graph_.create(unsigned(probable), unsigned(2 * kBefore * probable));
    for_each_probable([&](const cv::Point& at) { add(at, behind, front); });
    graph_.addEdges(0, 1, 0, 0);  // maxFlow needs an edge, and all pixels may be apart
    graph_.maxFlow();
    cv::Mat decided = labels_.clone();
    for_each_probable([&](const cv::Point& at) {
      decided.at<std::uint8_t>(at) =
          graph_.inSourceSegment(nodes_(at)) ? cv::GC_PR_FGD : cv::GC_PR_BGD;
    });
    return decided;
  }

 private:
  template <typename Visit>
  void for_each_probable(const Visit& visit) const {
    for (int y = 0; y < labels_.rows; ++y)
      for (int x = 0; x < labels_.cols; ++x)
        if (const std::uint8_t label = labels_.at<std::uint8_t>(y, x);
            label == cv::GC_PR_BGD || label == cv::GC_PR_FGD)
          visit(cv::Point(x, y));
  }

  void add(const cv::Point& at, const Mixture& behind, const Mixture& front) {
    constexpr double kGamma = 50;  // [Rother04]
    const cv::Vec3b& here = colours_.at<cv::Vec3b>(at);
    const int node = nodes_(at) = graph_.addVtx();
    double to_front = behind.cost(here) + lead_, to_behind = front.cost(here);
    for (int i = 0; i < 2 * kBefore; ++i) {
      const cv::Point there = at + kNeighbours[i];
      if (!there.inside(cv::Rect({0, 0}, labels_.size()))) continue;
      const double length = kNeighbours[i].x != 0 && kNeighbours[i].y != 0 ? std::sqrt(2.0) : 1;
      const double weight =
          kGamma / length *
          std::exp(-beta_ * squared_difference(here, colours_.at<cv::Vec3b>(there)));
      const std::uint8_t label = labels_.at<std::uint8_t>(there);
      if (label == cv::GC_FGD)
        to_front += weight;
      else if (label == cv::GC_BGD)
        to_behind += weight;
      else if (i < kBefore)
        graph_.addEdges(node, nodes_(there), weight, weight);
    }
    graph_.addTermWeights(node, to_front, to_behind);
  }

  const cv::Mat &colours_, &labels_;
  double beta_, lead_;
  cv::Mat_<int> nodes_;
  cv::detail::GCGraph<double> graph_;
};

/// Are there enough pixels of both sides to learn colours from?
bool tell_both_sides(const cv::Mat& labels) {
  return cv::countNonZero(labels == cv::GC_FGD) >= kFewestCertain &&
         cv::countNonZero(labels == cv::GC_BGD) >= kFewestCertain;
}

/// Decides the probable labels. The colours of both sides are learnt from some of the pixels, or
/// from all where these hold too few of a side.
cv::Mat cut(const cv::Mat& colours, const cv::Mat& labels) {
  const double scale = std::min(1.0, std::sqrt(kLearnt / double(colours.total())));
  cv::Mat few, few_labels, behind, front;
  cv::resize(colours, few, {}, scale, scale, cv::INTER_NEAREST);
  cv::resize(labels, few_labels, few.size(), 0, 0, cv::INTER_NEAREST);
  if (!tell_both_sides(few_labels)) few = colours, few_labels = labels.clone();
  cv::setRNGSeed(1);  // its clusters start at random
  cv::grabCut(few, few_labels, {}, behind, front, kIterations, cv::GC_INIT_WITH_MASK);
  return BandGraph(colours, labels, 0).cut(Mixture(behind), Mixture(front));
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
  if (!tell_both_sides(labels)) return mask;
  labels = cut(coded(image, box), labels);
  cv::Mat inside = (labels == cv::GC_FGD) | (labels == cv::GC_PR_FGD);
  soften_contour(distance, inside);
  Mask out{mask.width, mask.height, std::vector<std::uint8_t>(mask.coverage.size(), 0)};
  inside.copyTo(cv::Mat(mask.height, mask.width, CV_8U, out.coverage.data())(box));
  return out;
}

cv::Mat background_by_colours(const MaskEvidence& evidence, const ColourImage& image,
                              const cv::Mat& unknown, const cv::Mat& background) {
  cv::Mat out(unknown.size(), CV_8U, cv::Scalar(0));
  cv::Rect box = cv::boundingRect(unknown);
  const int margin = std::max(box.width, box.height) / 2;
  box = (box + cv::Size(2 * margin, 2 * margin) - cv::Point(margin, margin)) &
        cv::Rect({}, unknown.size());
  if (box.empty() || box.area() > kMostPixels) return out;
  const cv::Mat colours = coded(image, box);
  cv::Mat labels(box.size(), CV_8U, cv::Scalar(cv::GC_BGD)), learnt = background(box) / 255;
  labels.setTo(cv::GC_FGD, evidence.distance(box) >= evidence.strong);
  labels.setTo(cv::GC_PR_BGD, unknown(box));
  learnt |= (labels == cv::GC_FGD) / 255;
  // Those alone, side by side: what is neither, such as the page, must not be learnt.
  const int step = 1 + int(double(cv::countNonZero(learnt)) / kLearnt);
  std::vector<cv::Vec3b> few;
  std::vector<std::uint8_t> few_labels;
  int count = 0;
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      if (learnt.at<std::uint8_t>(y, x) && count++ % step == 0) {
        few.push_back(colours.at<cv::Vec3b>(y, x));
        few_labels.push_back(labels.at<std::uint8_t>(y, x));
      }
  cv::Mat sides(few_labels), behind, front;
  if (few.empty() || !tell_both_sides(sides)) return out;
  cv::setRNGSeed(1);
  cv::grabCut(cv::Mat(few), sides, {}, behind, front, kIterations, cv::GC_INIT_WITH_MASK);
  labels = BandGraph(colours, labels, kLead).cut(Mixture(behind), Mixture(front));
  out(box).setTo(255, labels == cv::GC_PR_BGD);
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
