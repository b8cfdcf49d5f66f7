#include "masks/find_sheet_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/median.h"
#include "masks/agreeing_light.h"
#include "masks/mask_evidence.h"
#include "photo/for_photographs.h"

namespace photohull {
namespace {

constexpr double kBare = 0.7;    // mm around a point that must be bare paper
constexpr float kPaper = 0.97f;  // share of bare paper from which on it is
constexpr int kFreeEnough = 3;   // photographs that the object cannot hide a place from
constexpr int kFewest = 4;       // photographs that agree
constexpr double kLeastShare = 1 / 3.0;
constexpr double kCosineApart = 0.5;                // 60 degrees
constexpr float kLeastWindow = 0.04f, kSigmas = 6;  // of the roots, relative: what agrees
constexpr float kHue = 0.12f;                       // relative
constexpr float kDarkest = 0.4f, kLightest = 1.5f;  // of the usual root
constexpr std::size_t kFewestFree = 100;
constexpr double kEven = 2;           // mm around a place that are lit alike, away from all edges
constexpr double kMostMoving = 0.02;  // of what is seen where the object cannot be
constexpr double kNear = 0.75, kAcrossInk = 4;  // mm: half of the windows that tell what is between
constexpr float kLeastBare = 0.05f;             // share of such a window on which photographs agree
constexpr float kMostAgree = 0.8f;              // share of its bare paper on which they must
constexpr int kRounds = 3;                      // exposures and light in turn

/// What a photograph shows of a lattice point.
struct Sample {
  std::uint8_t root[3];  ///< 255: light 1
  std::uint8_t place;    ///< 0: not seen; else distance from the middle, squared, and kFree
  static constexpr std::uint8_t kFree = 64, kSteps = 62;

  bool seen() const { return place != 0; }
  bool free() const { return (place & kFree) != 0; }
  float r2() const { return float((place & (kFree - 1)) - 1) / kSteps; }
  glm::vec3 roots() const { return glm::vec3(root[0], root[1], root[2]) / 255.0f; }
};

/// How a photograph makes roots of light of those on the sheet.
struct Exposure {
  glm::vec3 gain{1.0f}, radial{0.0f};
  glm::vec3 at(float r2) const { return glm::max(gain + r2 * radial, glm::vec3(1e-3f)); }
};

float mean(const glm::vec3& v) { return (v.x + v.y + v.z) / 3; }

class Search {
 public:
  explicit Search(const SheetPhotographs& photos) : photos_(photos) {
    const double area = photos.page.x * photos.page.y;
    const double step = std::max(
        photos.finest, std::sqrt(area * double(photos.count) * sizeof(Sample) / photos.held));
    out_.texels_per_mm = 1 / step;
    out_.lower_left = photos.lower_left;
    out_.width = std::max(1, int(std::ceil(photos.page.x / step)));
    out_.height = std::max(1, int(std::ceil(photos.page.y / step)));
    texels_ = std::size_t(out_.width) * std::size_t(out_.height);
    out_.paper.assign(texels_, glm::vec3(0.0f));
    out_.agreed.assign(texels_, 0);
  }

  SheetLight run() {
    find_bare();
    samples_.resize(photos_.count);
    eyes_.resize(photos_.count);
    for_photographs(
        photos_.count, photos_.pixels, [&](std::size_t k) { sample(k); }, photos_.read);
    start_exposures();
    for (int round = 0; round < kRounds; ++round) {
      average_free();
      tbb::parallel_for(std::size_t(0), photos_.count, [&](std::size_t k) { fit_exposure(k); });
    }
    average_free();
    if (std::size_t(std::ranges::count(out_.agreed, 255)) < kFewestFree) return {};
    note_usual();
    out_.steady = is_steady();
    let_groups_agree();
    fill();
    agree_between();
    return std::move(out_);
  }

 private:
  glm::dvec2 place(std::size_t i) const {
    const auto x = double(i % std::size_t(out_.width)), y = double(i / std::size_t(out_.width));
    return out_.lower_left + glm::dvec2(x + 0.5, out_.height - y - 0.5) / out_.texels_per_mm;
  }

  template <typename Visit>
  void for_each_texel(const Visit& visit) const {
    const std::size_t width = std::size_t(out_.width);
    tbb::parallel_for(0, out_.height, [&](int y) {
      for (std::size_t x = 0; x < width; ++x) visit(std::size_t(y) * width + x);
    });
  }

  void find_bare() {
    bare_.assign(texels_, 0);
    for_each_texel([&](std::size_t i) {
      const glm::dvec2 at = place(i);
      bool bare = true;
      for (int v = -1; v <= 1 && bare; ++v)
        for (int u = -1; u <= 1 && bare; ++u)
          bare = photos_.print(at + kBare * glm::dvec2(u, v)) > kPaper;
      bare_[i] = bare ? 255 : 0;
    });
  }

  void sample(std::size_t k) {
    const cv::Mat taken = light_roots(photos_.image(k));
    const glm::dvec2 middle(0.5 * (taken.cols - 1), 0.5 * (taken.rows - 1));
    std::vector<Sample> samples(texels_, Sample{});
    for_each_texel([&](std::size_t i) {
      if (!bare_[i]) return;
      const glm::dvec2 at = place(i);
      const auto p = photos_.pixel(k, at);
      if (!p || !(p->x >= 1 && p->y >= 1 && p->x < taken.cols - 2 && p->y < taken.rows - 2)) return;
      const int x = int(p->x), y = int(p->y);
      const float u = float(p->x - x), v = float(p->y - y);
      const cv::Vec3f root =
          (1 - v) * ((1 - u) * taken.at<cv::Vec3f>(y, x) + u * taken.at<cv::Vec3f>(y, x + 1)) +
          v * ((1 - u) * taken.at<cv::Vec3f>(y + 1, x) + u * taken.at<cv::Vec3f>(y + 1, x + 1));
      Sample& s = samples[i];
      for (int c = 0; c < 3; ++c)
        s.root[c] = std::uint8_t(std::lround(255 * std::clamp(root[c], 0.0f, 1.0f)));
      const double r2 = glm::dot(*p - middle, *p - middle) / glm::dot(middle, middle);
      s.place = std::uint8_t(1 + std::lround(Sample::kSteps * std::min(1.0, r2)));
      if (!photos_.possible(k, at, *p, {taken.cols, taken.rows})) s.place |= Sample::kFree;
    });
    samples_[k] = std::move(samples);
    eyes_[k] = photos_.eye(k);
  }

  void start_exposures() {
    exposures_.resize(photos_.count);
    for (std::size_t k = 0; k < photos_.count; ++k)
      for (int c = 0; c < 3; ++c) {
        std::vector<double> values;
        for (std::size_t i = 0; i < texels_; i += 7)
          if (samples_[k][i].free()) values.push_back(double(samples_[k][i].roots()[c]));
        if (values.size() >= 20) exposures_[k].gain[c] = std::max(0.01f, float(median(values)));
      }
  }

  /// The light on a place as the photograph has it, exposed as all are.
  glm::vec3 light(std::size_t k, std::size_t i) const {
    const Sample& s = samples_[k][i];
    return s.roots() / exposures_[k].at(s.r2());
  }

  /// Medians of the photographs that the object cannot hide a place from.
  void average_free() {
    for_each_texel([&](std::size_t i) {
      thread_local std::array<std::vector<float>, 3> values;
      for (std::vector<float>& channel : values) channel.clear();
      for (std::size_t k = 0; k < photos_.count; ++k)
        if (samples_[k][i].free()) {
          const glm::vec3 l = light(k, i);
          for (int c = 0; c < 3; ++c) values[std::size_t(c)].push_back(l[c]);
        }
      out_.agreed[i] = values[0].size() >= kFreeEnough ? 255 : 0;
      if (!out_.agreed[i]) return;
      for (int c = 0; c < 3; ++c) {
        std::vector<float>& channel = values[std::size_t(c)];
        const auto middle = channel.begin() + std::ptrdiff_t(channel.size() / 2);
        std::nth_element(channel.begin(), middle, channel.end());
        out_.paper[i][c] = *middle;
      }
    });
  }

  /// Gain and its change with the distance from the middle, by what the other photographs show.
  void fit_exposure(std::size_t k) {
    for (int c = 0; c < 3; ++c) {
      std::vector<std::array<double, 2>> seen;  // ratio, distance squared
      for (std::size_t i = 0; i < texels_; i += 3) {
        const Sample& s = samples_[k][i];
        if (!s.free() || !out_.agreed[i] || !(out_.paper[i][c] > 0.01f)) continue;
        seen.push_back({double(s.roots()[c] / out_.paper[i][c]), double(s.r2())});
      }
      if (seen.size() < kFewestFree) continue;
      const cv::Vec2d line = fit_line(seen);
      exposures_[k].gain[c] = float(line[0]), exposures_[k].radial[c] = float(line[1]);
    }
  }

  static cv::Vec2d fit_line(const std::vector<std::array<double, 2>>& seen) {
    constexpr double kStiff = 0.02;  // where all are at one distance nothing tells the fall-off
    std::vector<double> ratios;
    for (const auto& s : seen) ratios.push_back(s[0]);
    cv::Vec2d line(median(ratios), 0);
    for (int round = 0; round < 4; ++round) {
      std::vector<double> off;
      for (const auto& s : seen) off.push_back(std::abs(s[0] - line[0] - line[1] * s[1]));
      const double spread = std::max(1e-3, 1.483 * median(off));
      double n = 0, x = 0, y = 0, xx = 0, xy = 0;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        const double w = 1 / (1 + std::pow(off[i] / (2 * spread), 2));
        n += w, x += w * seen[i][1], y += w * seen[i][0];
        xx += w * seen[i][1] * seen[i][1], xy += w * seen[i][1] * seen[i][0];
      }
      const double slope = (n * xy - x * y) / (n * xx - x * x + kStiff * kStiff * n * n);
      line = {(y - slope * x) / n, slope};
    }
    return line;
  }

  /// Usual light, and how much photographs differ in it.
  void note_usual() {
    std::array<std::vector<double>, 3> lights;
    std::vector<double> off;
    for (std::size_t i = 0; i < texels_; i += 5) {
      if (!out_.agreed[i]) continue;
      for (int c = 0; c < 3; ++c) lights[std::size_t(c)].push_back(double(out_.paper[i][c]));
      for (std::size_t k = 0; k < photos_.count; ++k)
        if (samples_[k][i].free())
          off.push_back(double(std::abs(mean(light(k, i)) / mean(out_.paper[i]) - 1)));
    }
    for (int c = 0; c < 3; ++c) usual_[c] = float(median(std::move(lights[std::size_t(c)])));
    window_ = {kLeastWindow, kSigmas * 1.483f * float(median(std::move(off))) * mean(usual_)};
  }

  /// Are shadows where the object cannot be in all photographs alike?
  bool is_steady() const {
    std::size_t seen = 0, darker = 0;
    for (std::size_t i = 0; i < texels_; ++i) {
      if (!out_.agreed[i] || !evenly_lit(i)) continue;
      for (std::size_t k = 0; k < photos_.count; ++k) {
        if (!samples_[k][i].free()) continue;
        ++seen;
        const float paper = mean(out_.paper[i]);
        darker += mean(light(k, i)) < paper - window(paper);
      }
    }
    return double(darker) <= kMostMoving * double(seen);
  }

  /// Away from the page's and shadows' edges, which photographs blur.
  bool evenly_lit(std::size_t i) const {
    const int step = std::max(1, int(std::lround(kEven * out_.texels_per_mm)));
    const int x = int(i % std::size_t(out_.width)), y = int(i / std::size_t(out_.width));
    if (x < step || y < step || x >= out_.width - step || y >= out_.height - step) return false;
    const float own = mean(out_.paper[i]);
    const auto down = std::ptrdiff_t(step) * out_.width;
    for (const std::ptrdiff_t off : {std::ptrdiff_t(-step), std::ptrdiff_t(step), -down, down}) {
      const auto j = std::size_t(std::ptrdiff_t(i) + off);
      if (!out_.agreed[j] || std::abs(mean(out_.paper[j]) - own) > 0.5f * window(own)) return false;
    }
    return true;
  }

  bool like_paper(const glm::vec3& light) const {
    const float size = mean(light) / mean(usual_);
    const glm::vec3 hue = light / (size * usual_);
    return size > kDarkest && size < kLightest &&
           glm::all(glm::lessThan(glm::abs(hue - 1.0f), glm::vec3(kHue)));
  }

  void let_groups_agree() {
    for_each_texel([&](std::size_t i) {
      if (!out_.agreed[i] && bare_[i]) agree_at(i);
    });
  }

  void agree_at(std::size_t i) {
    std::vector<SeenLight> seen;
    for (std::size_t k = 0; k < photos_.count; ++k)
      if (samples_[k][i].seen()) seen.push_back({light(k, i), mean(light(k, i)), k});
    if (int(seen.size()) < kFewest) return;
    const std::vector<SeenLight> group = take_largest_group(seen, window_);
    if (int(group.size()) < kFewest ||
        double(group.size()) < kLeastShare * double(seen.size() + group.size()))
      return;
    if (2 * take_largest_group(seen, window_).size() >= group.size()) return;
    glm::vec3 sum(0.0f);
    for (const SeenLight& s : group) sum += s.light;
    sum /= float(group.size());
    if (!like_paper(sum) || !far_apart(group, place(i))) return;
    out_.paper[i] = sum;
    out_.agreed[i] = 255;
  }

  float window(float light) const { return window_.at(light); }

  bool far_apart(const std::vector<SeenLight>& group, const glm::dvec2& at) const {
    const auto direction = [&](const SeenLight& s) {
      return glm::normalize(eyes_[s.photo] - glm::dvec3(at, 0));
    };
    for (const SeenLight& a : group)
      for (const SeenLight& b : group)
        if (glm::dot(direction(a), direction(b)) < kCosineApart) return true;
    return false;
  }

  /// Continues the light to where it is not known, from near to far.
  void fill() {
    cv::Mat light(out_.height, out_.width, CV_32FC3, out_.paper.data());
    const cv::Mat known(out_.height, out_.width, CV_8U, out_.agreed.data());
    cv::Mat weight;
    known.convertTo(weight, CV_32F, 1 / 255.0);
    light.setTo(cv::Scalar::all(0), ~known);
    cv::Mat open = ~known, spread = light.clone();
    for (double reach = 1; cv::countNonZero(open) > 0; reach *= 2) {
      const bool last = reach > std::max(out_.width, out_.height);
      cv::Mat sums, weights;
      if (last) {
        sums = cv::Mat(light.size(), CV_32FC3,
                       cv::Scalar(double(usual_.x), double(usual_.y), double(usual_.z)));
        weights = cv::Mat(light.size(), CV_32F, cv::Scalar(1));
      } else {
        const int side = 2 * int(2 * reach) + 1;
        cv::blur(spread, sums, {side, side});
        cv::blur(weight, weights, {side, side});
      }
      for (int y = 0; y < light.rows; ++y)
        for (int x = 0; x < light.cols; ++x)
          if (open.at<std::uint8_t>(y, x) && weights.at<float>(y, x) > 0.05f) {
            light.at<cv::Vec3f>(y, x) = sums.at<cv::Vec3f>(y, x) / weights.at<float>(y, x);
            open.at<std::uint8_t>(y, x) = 0;
          }
      if (last) break;
    }
  }

  /// Single places, and ink, among bare ones on which photographs agree and which are lit alike.
  void agree_between() {
    const cv::Mat light(out_.height, out_.width, CV_32FC3, out_.paper.data());
    cv::Mat agreed(out_.height, out_.width, CV_8U, out_.agreed.data());
    const cv::Mat bare(out_.height, out_.width, CV_8U, bare_.data());
    const cv::Mat known = agreed & (bare > 0);
    cv::Mat brightness;
    cv::transform(light, brightness, cv::Matx13f(1 / 3.0f, 1 / 3.0f, 1 / 3.0f));
    const auto side = [&](double reach) {
      return 2 * int(std::lround(reach * out_.texels_per_mm)) + 1;
    };
    const auto between = [&](double reach) {
      const cv::Size around(side(reach), side(reach));
      cv::Mat all, sure, sums, squares, masked(brightness.size(), CV_32F, cv::Scalar(0));
      brightness.copyTo(masked, known);
      cv::boxFilter(bare > 0, all, CV_32F, around, {-1, -1}, true);
      cv::boxFilter(known, sure, CV_32F, around, {-1, -1}, true);
      cv::boxFilter(masked, sums, CV_32F, around, {-1, -1}, true);
      cv::boxFilter(masked.mul(masked), squares, CV_32F, around, {-1, -1}, true);
      cv::Mat out(brightness.size(), CV_8U, cv::Scalar(0));
      for (int y = 0; y < out.rows; ++y)
        for (int x = 0; x < out.cols; ++x) {
          const float share = sure.at<float>(y, x) / 255;  // of the window
          if (!(share > kLeastBare) || share < kMostAgree * all.at<float>(y, x) / 255) continue;
          const float m = sums.at<float>(y, x) / share, v = squares.at<float>(y, x) / share - m * m;
          if (v < std::pow(0.5f * window(m), 2.0f)) out.at<std::uint8_t>(y, x) = 255;
        }
      return out;
    };
    const cv::Mat near = between(kNear), far = between(kAcrossInk);
    agreed.setTo(255, (near & (bare > 0)) | (far & (bare == 0)));
  }

  const SheetPhotographs& photos_;
  SheetLight out_;
  std::size_t texels_ = 0;
  std::vector<std::uint8_t> bare_;
  std::vector<std::vector<Sample>> samples_;
  std::vector<glm::dvec3> eyes_;
  std::vector<Exposure> exposures_;
  glm::vec3 usual_{1.0f};
  LightWindow window_;
};

}  // namespace

SheetLight find_sheet_light(const SheetPhotographs& photographs) {
  if (photographs.count == 0) return {};
  return Search(photographs).run();
}

}  // namespace photohull
