#include "masks/sheet_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/median.h"
#include "masks/behind_sheet.h"
#include "masks/continued_object.h"
#include "masks/mask_evidence.h"
#include "masks/nearest_pixel.h"

namespace photohull {
namespace {

constexpr float kPaper = 0.97f, kInk = 0.03f;  // from where on, up to where a pixel is one of both
constexpr std::size_t kFewest = 200;           // pixels to measure paper by
constexpr double kPlain = 0.05;  // deviation of a background that tells, roots of linear light
constexpr int kTerms = 6;
constexpr int kShadowEdge = 4;  // pixels: half of the window that looks for texture, and the edge

/// 1, x, y and their products, of a pixel's place from -1 to 1; `radial`: 1 and the distance from
/// the middle, squared, alone.
std::array<double, kTerms> terms(const cv::Point& at, const cv::Size& size, bool radial) {
  const double x = 2.0 * at.x / size.width - 1, y = 2.0 * at.y / size.height - 1;
  if (radial) return {1, 0, 0, x * x + y * y, 0, 0};
  return {1, x, y, x * x, x * y, y * y};
}

/// A form of these terms through the values of places, robustly: shadows are darker.
cv::Vec6d fit(const std::vector<cv::Point>& places, const std::vector<double>& values,
              const cv::Size& size, bool radial) {
  std::vector<double> weights(places.size(), 1.0);
  cv::Vec6d form;
  for (int round = 0; round < 8; ++round) {
    cv::Matx<double, kTerms, kTerms> normal = cv::Matx<double, kTerms, kTerms>::eye() * 1e-6;
    cv::Vec6d right;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto t = terms(places[i], size, radial);
      for (int a = 0; a < kTerms; ++a) {
        right[a] += weights[i] * t[std::size_t(a)] * values[i];
        for (int b = 0; b < kTerms; ++b)
          normal(a, b) += weights[i] * t[std::size_t(a)] * t[std::size_t(b)];
      }
    }
    form = normal.solve(right, cv::DECOMP_CHOLESKY);
    std::vector<double> off;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto t = terms(places[i], size, radial);
      double value = 0;
      for (int a = 0; a < kTerms; ++a) value += form[a] * t[std::size_t(a)];
      off.push_back(values[i] - value);
    }
    std::vector<double> sizes;
    for (const double o : off) sizes.push_back(std::abs(o));
    const double spread = std::max(1e-3, 1.483 * median(sizes));
    for (std::size_t i = 0; i < off.size(); ++i)
      weights[i] = 1 / (1 + std::pow(off[i] / (2 * spread), 2));
  }
  return form;
}

/// MaskEvidence::doubt without the contour, where pixels show both sides in part: of thin parts,
/// that is nearly all. Nor does noise count that is nowhere near.
double doubt_within(const MaskEvidence& evidence) {
  constexpr int kMixed = 2;  // pixels
  constexpr int kNear = 12;
  const cv::Mat strong = evidence.distance >= evidence.strong;
  cv::Mat contour, near;
  cv::dilate(strong, contour, square(kMixed));
  cv::dilate(strong, near, square(kNear));
  cv::Mat weak = near & ~contour & (evidence.distance >= evidence.weak);
  cv::morphologyEx(weak, weak, cv::MORPH_OPEN, square(1));
  const double doubtful = cv::countNonZero(weak), sure = cv::countNonZero(strong);
  return doubtful > 0 ? doubtful / (doubtful + sure) : 0;
}

class Comparison {
 public:
  Comparison(const ColourImage& image, const SheetLook& look, const StillBackground& still)
      : taken_(light_roots(image)),
        light_(look.height, look.width, CV_32F, const_cast<float*>(look.light.data())),
        possible_(look.height, look.width, CV_8U, const_cast<std::uint8_t*>(look.possible.data())),
        page_(light_ >= 0),
        expected_(taken_.clone()),
        mixed_(look.mixed),
        hull_(look.hull),
        paper_(look.paper),
        agreed_(look.agreed),
        steady_(look.steady) {
    if (!still.empty()) behind_.emplace(still, taken_);
  }

  SheetMask run(const ColourImage& image) {
    SheetMask out;
    if (!expect_page()) return out;
    cv::Mat unknown = expect_surroundings();
    const cv::Mat certain = page_ & ~possible_;
    MaskEvidence evidence =
        compare_with_expected(taken_, expected_, certain, kShadowEdge,
                              behind_ ? behind_->deviation : cv::Mat(), shaded());
    bridge_edges_of_print(evidence);
    if (behind_) unknown |= disbelieved(*behind_, {page_, possible_, unknown}, evidence);
    if (!paper_.empty() || behind_) evidence.bare = bare(evidence, unknown);
    evidence.distance.setTo(0, ~possible_);
    evidence.doubt = doubt_within(evidence);
    if (!hull_.empty()) {
      const cv::Mat continued = continued_object(taken_, evidence, possible_ & hull());
      evidence.distance.setTo(255, continued);
      if (!evidence.bare.empty()) evidence.bare.setTo(0, continued);
    }
    if (behind_)
      unknown &= ~background_by_colours(evidence, image, unknown,
                                        ~page_ & ~unknown & (evidence.distance < evidence.weak));
    evidence.distance.setTo(255, unknown);
    if (!evidence.bare.empty()) evidence.bare.setTo(0, unknown);
    out.undecided = double(cv::countNonZero(unknown)) / std::max(1, cv::countNonZero(possible_));
    out.mask = mask_from_evidence(evidence);
    if (std::none_of(out.mask.coverage.begin(), out.mask.coverage.end(),
                     [](std::uint8_t c) { return c >= 128; }))
      return {};
    return out;
  }

 private:
  /// What paper and ink send to the camera, where the page is seen. False where too little of it is
  /// seen.
  bool expect_page() {
    std::vector<cv::Point> paper, ink;
    const cv::Mat certain = page_ & ~possible_;
    const int step = std::max(1, int(std::sqrt(double(cv::countNonZero(certain)) / 20000)));
    for (int y = 0; y < light_.rows; y += step)
      for (int x = 0; x < light_.cols; x += step) {
        if (!certain.at<std::uint8_t>(y, x)) continue;
        const float light = light_.at<float>(y, x);
        if (light > kPaper && is_known({x, y})) paper.emplace_back(x, y);
        if (light < kInk) ink.emplace_back(x, y);
      }
    if (paper.size() < kFewest || ink.size() < kFewest / 10) return false;
    for (int c = 0; c < 3; ++c) expect_channel(c, paper, ink);
    return true;
  }

  /// Where all shadow on the page is known.
  cv::Mat shaded() const {
    if (!steady_) return {};
    return cv::Mat(taken_.size(), CV_8U, const_cast<std::uint8_t*>(agreed_.data())) & page_;
  }

  /// At the print's edges a pixel may have any light between paper's and ink's, and tells nothing:
  /// it is the object's where that is on both sides of it.
  void bridge_edges_of_print(MaskEvidence& evidence) const {
    constexpr float kEdge = 0.1f;  // of the paper's light
    constexpr int kAcross = 3;     // pixels: half of what an edge is wide
    cv::Mat low, high, both;
    cv::erode(light_, low, square(2));
    cv::dilate(light_, high, square(2));
    cv::morphologyEx(evidence.distance, both, cv::MORPH_CLOSE, square(kAcross));
    both.copyTo(evidence.distance, page_ & (high - low > kEdge) & (both >= evidence.strong));
  }

  /// Where all around a pixel is as expected, and what is expected is no guess.
  cv::Mat bare(const MaskEvidence& evidence, const cv::Mat& unknown) const {
    cv::Mat around;  // what is strong beside a pixel says no more of it than that it is not far
    cv::blur(cv::min(evidence.distance, evidence.strong), around, {3, 3});
    const cv::Mat agreed =
        agreed_.empty() ? page_
                        : cv::Mat(taken_.size(), CV_8U, const_cast<std::uint8_t*>(agreed_.data()));
    cv::Mat beside = ~page_ & ~unknown;
    if (behind_) beside &= behind_->level != StillBackground::kUnknown;
    return (around < evidence.weak / 2) & ((page_ & agreed) | beside);
  }

  cv::Mat hull() const { return {taken_.size(), CV_8U, const_cast<std::uint8_t*>(hull_.data())}; }
  std::size_t index(const cv::Point& at) const {
    return std::size_t(at.y) * std::size_t(taken_.cols) + std::size_t(at.x);
  }
  bool is_known(const cv::Point& at) const { return agreed_.empty() || agreed_[index(at)] != 0; }
  /// What bare paper sends there, as all photographs tell, but for the exposure.
  double known_paper(const cv::Point& at, int c) const {
    return paper_.empty() ? 1.0 : std::max(1e-3, double(paper_[index(at)][c]));
  }

  void expect_channel(int c, const std::vector<cv::Point>& paper,
                      const std::vector<cv::Point>& ink) {
    std::vector<double> values, shares;
    const bool radial = !paper_.empty();  // it is known but for exposure and the lens's fall-off
    for (const cv::Point& at : paper)
      values.push_back(double(taken_.at<cv::Vec3f>(at)[c]) / known_paper(at, c));
    const cv::Vec6d form = fit(paper, values, taken_.size(), radial);
    const auto paper_at = [&](const cv::Point& at) {
      const auto t = terms(at, taken_.size(), radial);
      double value = 0;
      for (int a = 0; a < kTerms; ++a) value += form[a] * t[std::size_t(a)];
      return std::max(value * known_paper(at, c), 1e-3);
    };
    for (const cv::Point& at : ink)
      shares.push_back(std::pow(double(taken_.at<cv::Vec3f>(at)[c]) / paper_at(at), 2));
    const double dark = std::clamp(median(shares), 0.0, 1.0);
    for (int y = 0; y < light_.rows; ++y)
      for (int x = 0; x < light_.cols; ++x) {
        if (!page_.at<std::uint8_t>(y, x)) continue;
        const double light = std::clamp(double(light_.at<float>(y, x)), 0.0, 1.0);
        expected_.at<cv::Vec3f>(y, x)[c] =
            float(paper_at({x, y}) * std::sqrt(dark + (1 - dark) * light));
      }
  }

  /// Beside the page: as the still background has it, else as the nearest place where the object
  /// cannot be. Returns where nothing is known (255), since what lies around is of many colours, or
  /// there is nothing.
  cv::Mat expect_surroundings() {
    const cv::Mat beside = ~page_, asked = beside & possible_;
    cv::Mat rim;  // of the page, which pixels show in part: neither paper nor background
    const int side = 2 * mixed_ + 1;
    cv::dilate(page_, rim, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
    cv::Mat unknown = asked.clone();
    if (expect_nearest(asked, beside & ~possible_ & ~rim)) unknown.setTo(0);
    if (behind_) {
      behind_->expose_as(taken_, beside & ~possible_ & ~rim);
      const cv::Mat known = asked & (behind_->level != StillBackground::kUnknown);
      behind_->light.copyTo(expected_, known);
      unknown.setTo(0, known);
    }
    // The page's rim is there whatever stands before it: it counts as background but for what
    // differs from both sides.
    const cv::Mat thin = asked & rim;
    const cv::Mat beyond = asked & ~rim & ~unknown;
    for (int y = 0; y < thin.rows; ++y)
      for (int x = 0; x < thin.cols; ++x) {
        std::uint8_t& open = unknown.at<std::uint8_t>(y, x);
        if (!thin.at<std::uint8_t>(y, x) || (open && !expect_beyond({x, y}, beyond))) continue;
        open = 0;
        settle_rim({x, y});
      }
    return unknown;
  }

  /// The mean of the background near a pixel of the page's rim, and its deviation. False where
  /// nothing is known.
  bool expect_beyond(const cv::Point& at, const cv::Mat& beyond) {
    const int reach = mixed_ + 2;
    cv::Vec3f sum;
    float squares = 0;
    int count = 0;
    for (int v = -reach; v <= reach; ++v)
      for (int u = -reach; u <= reach; ++u) {
        const cv::Point near = at + cv::Point(u, v);
        if (!near.inside(cv::Rect({}, page_.size())) || !beyond.at<std::uint8_t>(near)) continue;
        const cv::Vec3f& light = expected_.at<cv::Vec3f>(near);
        sum += light, squares += light.dot(light), ++count;
      }
    if (count == 0) return false;
    const cv::Vec3f mean = sum * (1.0f / float(count));
    expected_.at<cv::Vec3f>(at) = mean;
    if (behind_)
      behind_->deviation.at<float>(at) =
          std::sqrt(std::max(0.0f, squares / float(count) - mean.dot(mean)) / 3);
    return true;
  }

  /// Where `asked`, as the nearest place of `source`. False where that is of many colours, or too
  /// small.
  bool expect_nearest(const cv::Mat& asked, const cv::Mat& source) {
    if (cv::countNonZero(source) < int(kFewest)) return false;
    cv::Scalar mean, deviation;
    cv::meanStdDev(taken_, mean, deviation, source);
    if (std::max({deviation[0], deviation[1], deviation[2]}) > kPlain) return false;
    cv::Mat smooth;
    cv::blur(taken_, smooth, {5, 5});
    const NearestPixel nearest(source);
    for (int y = 0; y < source.rows; ++y)
      for (int x = 0; x < source.cols; ++x)
        if (asked.at<std::uint8_t>(y, x))
          expected_.at<cv::Vec3f>(y, x) = smooth.at<cv::Vec3f>(nearest.of({x, y}));
    return true;
  }

  /// A pixel that mixes page and background: what it would be of the mixture nearest to it. What
  /// is mixed is the brightest part of the page nearby, for no print reaches its edge.
  void settle_rim(const cv::Point& at) {
    constexpr float kAsBright = 0.05f;  // of the paper's light
    const cv::Rect window = cv::Rect(at.x - mixed_, at.y - mixed_, 2 * mixed_ + 1, 2 * mixed_ + 1) &
                            cv::Rect({}, page_.size());
    double brightest = 0;
    cv::minMaxLoc(light_(window), nullptr, &brightest);
    cv::Vec3f paper;
    int count = 0;
    for (int y = window.y; y < window.br().y; ++y)
      for (int x = window.x; x < window.br().x; ++x) {
        const cv::Point near(x, y);
        if (!page_.at<std::uint8_t>(near) || light_.at<float>(near) < float(brightest) - kAsBright)
          continue;
        paper += expected_.at<cv::Vec3f>(near), ++count;
      }
    if (count == 0) return;
    paper *= 1.0f / float(count);
    cv::Vec3f& behind = expected_.at<cv::Vec3f>(at);
    const cv::Vec3f span = paper - behind, here = taken_.at<cv::Vec3f>(at) - behind;
    const float share = span.dot(span) > 0 ? here.dot(span) / span.dot(span) : 0.0f;
    behind += std::clamp(share, 0.0f, 1.0f) * span;
  }

  cv::Mat taken_, light_, possible_, page_, expected_;
  int mixed_;
  const std::vector<std::uint8_t>& hull_;
  const std::vector<glm::vec3>& paper_;
  const std::vector<std::uint8_t>& agreed_;
  bool steady_;
  std::optional<Behind> behind_;
};

}  // namespace

SheetMask mask_from_sheet(const ColourImage& image, const SheetLook& look,
                          const StillBackground& still) {
  PHOTOHULL_CHECK_OP(image.width, ==, look.width);
  PHOTOHULL_CHECK_OP(image.height, ==, look.height);
  if (!still.empty()) PHOTOHULL_CHECK(still.width == image.width && still.height == image.height);
  return Comparison(image, look, still).run(image);
}

void keep_shares(Mask& mask) {
  constexpr std::uint8_t kHalf = 128;
  constexpr double kSpeck = 0.0005;  // of the largest part
  cv::Mat coverage(mask.height, mask.width, CV_8U, mask.coverage.data()), labels, sizes, middles;
  const int count =
      cv::connectedComponentsWithStats(coverage >= kHalf, labels, sizes, middles, 8, CV_32S);
  int largest = 0;
  for (int i = 1; i < count; ++i) largest = std::max(largest, sizes.at<int>(i, cv::CC_STAT_AREA));
  cv::Mat near(coverage.size(), CV_8U, cv::Scalar(0));
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const int part = labels.at<int>(y, x);
      if (part > 0 && sizes.at<int>(part, cv::CC_STAT_AREA) >= kSpeck * largest)
        near.at<std::uint8_t>(y, x) = 255;
    }
  cv::dilate(near, near, square(1));
  coverage.setTo(0, ~near);
}

void keep_parts_in(const Mask& shadow, Mask& mask) {
  constexpr std::uint8_t kHalf = 128;
  if (shadow.empty()) return;
  cv::Mat coverage(mask.height, mask.width, CV_8U, mask.coverage.data()), where, labels;
  cv::resize(cv::Mat(shadow.height, shadow.width, CV_8U,
                     const_cast<std::uint8_t*>(shadow.coverage.data())),
             where, coverage.size(), 0, 0, cv::INTER_NEAREST);
  std::vector<bool> met(std::size_t(cv::connectedComponents(coverage >= kHalf, labels, 8, CV_32S)));
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (where.at<std::uint8_t>(y, x)) met[std::size_t(labels.at<int>(y, x))] = true;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (const int part = labels.at<int>(y, x); part > 0 && !met[std::size_t(part)])
        coverage.at<std::uint8_t>(y, x) = 0;
}

}  // namespace photohull
