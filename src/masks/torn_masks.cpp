#include "masks/torn_masks.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/error.h"

namespace photohull {
namespace {

constexpr int kCells = 512;          // along the image's longer side, at most
constexpr double kBite = 0.06;       // radius that rolls along the outline, of the longer side
constexpr int kBins = 16;            // of a channel's sRGB code
constexpr double kUnseen = 1e-4;     // share that every colour has
constexpr double kSeparable = 0.1;   // most of the background that may look like the object
constexpr double kRecognised = 0.8;  // least of the object that must not look like the background
constexpr double kSure = 1;          // mean logarithm of the likelihoods' ratio
constexpr double kAgree = 0.7;       // of a region's pixels
constexpr int kStep = 4;             // cells, over the rim
constexpr double kEdge = 2.2;        // times the object's own steps
constexpr int kFewest = 8;           // cells without any coverage

/// Relative frequency of colours, smoothed over neighbouring bins.
class Colours {
 public:
  Colours() : bins_(3, kSizes, CV_32F, cv::Scalar(0)) {}

  void add(const cv::Vec3i& bin) { bins_.at<float>(bin) += 1, total_ += 1; }
  bool known() const { return total_ > 0; }
  void finish() {
    cv::Mat smooth = bins_.clone();
    for (int axis = 0; axis < 3; ++axis) {
      const cv::Mat before = smooth.clone();
      for_bins([&](const cv::Vec3i& bin) {
        cv::Vec3i a = bin, b = bin;
        a[axis] = std::max(0, a[axis] - 1), b[axis] = std::min(kBins - 1, b[axis] + 1);
        smooth.at<float>(bin) =
            0.5f * before.at<float>(bin) + 0.25f * (before.at<float>(a) + before.at<float>(b));
      });
    }
    bins_ = smooth / total_;
  }
  double share(const cv::Vec3i& bin) const { return bins_.at<float>(bin); }

  template <typename Work>
  static void for_bins(const Work& work) {
    for (int r = 0; r < kBins; ++r)
      for (int g = 0; g < kBins; ++g)
        for (int b = 0; b < kBins; ++b) work(cv::Vec3i(r, g, b));
  }

 private:
  static constexpr int kSizes[3] = {kBins, kBins, kBins};
  cv::Mat bins_;
  double total_ = 0;
};

/// How likely a colour is the object's.
struct Model {
  Colours object, background;

  double evidence(const cv::Vec3i& bin) const {
    return std::log((object.share(bin) + kUnseen) / (background.share(bin) + kUnseen));
  }
  bool separates() const {
    double mistaken = 0, recognised = 0;
    Colours::for_bins([&](const cv::Vec3i& bin) {
      if (!(evidence(bin) > 0)) return;
      mistaken += background.share(bin);
      recognised += object.share(bin);
    });
    return mistaken <= kSeparable && recognised >= kRecognised;
  }
};

/// The mask in cells of so many pixels a side, and the photograph's colours there.
class Cells {
 public:
  Cells(const ColourImage& image, const Mask& mask)
      : image_(image),
        side_(std::max(1, (std::max(mask.width, mask.height) + kCells - 1) / kCells)) {
    const cv::Mat pixels(mask.height, mask.width, CV_8U,
                         const_cast<std::uint8_t*>(mask.coverage.data()));
    const cv::Size size(mask.width / side_, mask.height / side_);
    cv::resize(pixels(cv::Rect(0, 0, size.width * side_, size.height * side_)), coverage, size, 0,
               0, cv::INTER_AREA);
    inside = coverage >= 128;
  }

  /// Was it photographed? Undistorted pictures have pixels that were not.
  bool known(int x, int y) const {
    return !image_.has_alpha || image_.linear(x * side_ + side_ / 2, y * side_ + side_ / 2).a > 0;
  }
  /// sRGB codes, 0 to 255.
  cv::Vec3f code(int x, int y) const {
    const int px = x * side_ + side_ / 2, py = y * side_ + side_ / 2;
    cv::Vec3f result;
    if (image_.encoding == ColourImage::Encoding::kSrgb8) {
      const std::uint8_t* p = &image_.bytes[(std::size_t(py) * image_.width + px) * 4];
      for (int i = 0; i < 3; ++i) result[i] = p[i];
    } else {
      const glm::vec4 linear = image_.linear(px, py);
      for (int i = 0; i < 3; ++i)
        result[i] = float(255 * srgb_from_linear(std::clamp(double(linear[i]), 0.0, 1.0)));
    }
    return result;
  }
  cv::Vec3i bin(int x, int y) const {
    const cv::Vec3f c = code(x, y);
    return {int(c[0]) * kBins / 256, int(c[1]) * kBins / 256, int(c[2]) * kBins / 256};
  }

  /// Full coverage for the pixels of these cells.
  void fill(const cv::Mat& cells, Mask& mask) const {
    for (int y = 0; y < cells.rows; ++y)
      for (int x = 0; x < cells.cols; ++x) {
        if (!cells.at<std::uint8_t>(y, x)) continue;
        for (int py = y * side_; py < (y + 1) * side_; ++py)
          std::fill_n(mask.coverage.begin() + std::ptrdiff_t(py) * mask.width + x * side_, side_,
                      std::uint8_t(255));
      }
  }

  int side() const { return side_; }

  cv::Mat coverage, inside;  ///< 0 to 255; 0 or 255

 private:
  const ColourImage& image_;
  int side_;  ///< pixels
};

/// Differences of colour between cells some steps apart: within the object, and across the border
/// between it and each region, where a tear has no edge.
struct Steps {
  double within = 0, count = 0;
  std::vector<double> across, counts;

  Steps(const Cells& cells, const cv::Mat& labels, std::size_t regions)
      : across(regions, 0), counts(regions, 0) {
    const auto whole = [&](int x, int y) { return cells.coverage.at<std::uint8_t>(y, x) == 255; };
    const auto region = [&](int x, int y) {
      return cells.coverage.at<std::uint8_t>(y, x) > 0 ? 0 : std::size_t(labels.at<int>(y, x));
    };
    const auto compare = [&](int x, int y, int u, int v) {
      const std::size_t label = whole(u, v) ? region(x, y) : whole(x, y) ? region(u, v) : 0;
      const bool both = whole(x, y) && whole(u, v);
      if (!both && label == 0) return;
      const double step = cv::norm(cells.code(x, y) - cells.code(u, v));
      (both ? within : across[label]) += step;
      (both ? count : counts[label]) += 1;
    };
    for (int y = 0; y < labels.rows; ++y)
      for (int x = 0; x < labels.cols; ++x) {
        if (x + kStep < labels.cols) compare(x, y, x + kStep, y);
        if (y + kStep < labels.rows) compare(x, y, x, y + kStep);
      }
  }

  bool edge(std::size_t region) const {
    return !(across[region] * count <= kEdge * within * counts[region]);
  }
};

/// Farther than `reach` cells from where `cells` is not 0.
cv::Mat far_from(const cv::Mat& cells, double reach) {
  cv::Mat distance;
  cv::distanceTransform(cells == 0, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance > reach;
}

/// Background that does not reach the image's border.
cv::Mat enclosed(const cv::Mat& inside) {
  cv::Mat around;
  cv::copyMakeBorder(inside, around, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::floodFill(around, {0, 0}, cv::Scalar(255));
  return around(cv::Rect(1, 1, inside.cols, inside.rows)) == 0;
}

}  // namespace

MendedMask mend_mask(const ColourImage& image, Mask& mask) {
  PHOTOHULL_CHECK_OP(image.width, ==, mask.width);
  PHOTOHULL_CHECK_OP(image.height, ==, mask.height);
  MendedMask result;
  const Cells cells(image, mask);
  if (cells.inside.empty() || cv::countNonZero(cells.inside) == 0) return result;
  const double reach = kBite * std::max(cells.inside.cols, cells.inside.rows);
  const cv::Mat away = far_from(cells.inside, reach);
  const cv::Mat closed = far_from(away, reach), holes = enclosed(cells.inside);
  const cv::Mat doubtful = (closed | holes) & ~cells.inside;
  if (cv::countNonZero(doubtful) == 0) return result;

  Model model;
  for (int y = 0; y < away.rows; ++y)
    for (int x = 0; x < away.cols; ++x) {
      if (!cells.known(x, y)) continue;
      if (cells.coverage.at<std::uint8_t>(y, x) == 255) model.object.add(cells.bin(x, y));
      if (away.at<std::uint8_t>(y, x) && !holes.at<std::uint8_t>(y, x))
        model.background.add(cells.bin(x, y));
    }
  if (!model.object.known() || !model.background.known()) return result;
  model.object.finish();
  model.background.finish();
  if (!model.separates()) return result;

  cv::Mat labels;
  const int count = cv::connectedComponents(doubtful, labels, 4);
  std::vector<double> evidence(std::size_t(count), 0), agreeing = evidence, seen = evidence;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const auto label = std::size_t(labels.at<int>(y, x));
      if (label == 0 || cells.coverage.at<std::uint8_t>(y, x) > 0) continue;
      const double e = model.evidence(cells.bin(x, y));
      evidence[label] += e, agreeing[label] += e > 0, seen[label] += 1;
    }
  const Steps steps(cells, labels, std::size_t(count));
  std::vector<bool> torn(std::size_t(count), false);
  for (std::size_t i = 1; i < torn.size(); ++i) {
    torn[i] = seen[i] >= kFewest && evidence[i] >= kSure * seen[i] &&
              agreeing[i] >= kAgree * seen[i] && !steps.edge(i);
    result.holes += torn[i];
  }
  if (result.holes == 0) return result;
  cv::Mat mended(labels.size(), CV_8U, cv::Scalar(0));
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (torn[std::size_t(labels.at<int>(y, x))]) mended.at<std::uint8_t>(y, x) = 255;
  result.share = double(cv::countNonZero(mended)) / cv::countNonZero(cells.inside);
  // With the rim, whose pixels are covered in part.
  cv::dilate(mended, mended, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  cells.fill(mended & (closed | holes | cells.inside), mask);
  return result;
}

}  // namespace photohull
