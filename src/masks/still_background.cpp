#include "masks/still_background.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/median.h"
#include "masks/mask_evidence.h"
#include "photo/for_photographs.h"

namespace photohull {
namespace {

constexpr int kFewest = 4;  // photographs that tell a pixel's light
constexpr int kRim = 2;     // pixels around the page that may show a part of it
constexpr int kJudgedWidth = 640;
constexpr float kLeastEdge = 0.02f;    // root of light in a pixel, smoothed
constexpr float kSameEdge = 0.5f;      // share of the edge by which it may differ
constexpr double kFewestEdges = 5e-4;  // of the pixels
constexpr double kStillShare = 0.6;    // of the edges
constexpr float kMostDeviation = 0.05f, kAgrees = 0.015f;  // roots of light
constexpr float kDiffers = 0.03f;
constexpr int kWindow = 2, kFewestInWindow = 9;  // pixels around a place; in it, beside the page
constexpr double kAgreeing = 0.5;  // of the window: an outline beside its middle leaves 3/5
constexpr std::ptrdiff_t kOther =
    3;  // photographs alike, from which on they may be the background's
constexpr float kMaxCode = 65535;
constexpr std::uint8_t kPage = 1, kBox = 2, kObject = 4;
constexpr std::uint8_t kSurely = 192;  // coverage

/// A photograph made smaller.
struct Sample {
  cv::Mat light;            ///< CV_16UC3, exposed as the first one
  cv::Mat covered;          ///< CV_8U: kPage, kBox
  cv::Vec3f gain{1, 1, 1};  ///< of the photograph over the first one
};

cv::Vec3f root_at(const cv::Mat& light, int y, int x) {
  const auto& code = light.at<cv::Vec3w>(y, x);
  return {float(code[0]) / kMaxCode, float(code[1]) / kMaxCode, float(code[2]) / kMaxCode};
}

float difference(const cv::Vec3f& a, const cv::Vec3f& b) {
  const cv::Vec3f d = a - b;
  return std::sqrt(d.dot(d) / 3);
}

float middle_of(std::vector<float>& values) {
  const auto middle = values.begin() + long(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Where the page, its rim and the box are.
cv::Mat covered_by(const SheetLook& look) {
  cv::Mat page(look.height, look.width, CV_8U), out(look.height, look.width, CV_8U);
  for (int y = 0; y < page.rows; ++y)
    for (int x = 0; x < page.cols; ++x)
      page.at<std::uint8_t>(y, x) =
          look.light[std::size_t(y) * std::size_t(look.width) + std::size_t(x)] >= 0 ? 255 : 0;
  const int side = 2 * kRim + 1;
  cv::dilate(page, page, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  for (int y = 0; y < page.rows; ++y)
    for (int x = 0; x < page.cols; ++x)
      out.at<std::uint8_t>(y, x) = std::uint8_t(
          (page.at<std::uint8_t>(y, x) ? kPage : 0) |
          (look.possible[std::size_t(y) * std::size_t(look.width) + std::size_t(x)] ? kBox : 0));
  return out;
}

/// Where the mask has the object.
void cover_object(const Mask& mask, cv::Mat& covered) {
  if (mask.empty()) return;
  for (int y = 0; y < covered.rows; ++y)
    for (int x = 0; x < covered.cols; ++x) {
      const auto u = std::size_t(x) * std::size_t(mask.width) / std::size_t(covered.cols);
      const auto v = std::size_t(y) * std::size_t(mask.height) / std::size_t(covered.rows);
      if (mask.coverage[v * std::size_t(mask.width) + u] >= kSurely)
        covered.at<std::uint8_t>(y, x) |= kObject;
    }
}

/// Usual ratio of two photographs, where neither shows page or box.
cv::Vec3f gain_between(const Sample& first, const Sample& other) {
  cv::Mat a, b;
  cv::blur(first.light, a, {5, 5});
  cv::blur(other.light, b, {5, 5});
  cv::Vec3f gain{1, 1, 1};
  for (int c = 0; c < 3; ++c) {
    std::vector<double> ratios;
    for (int y = 0; y < a.rows; y += 2)
      for (int x = 0; x < a.cols; x += 2) {
        if (first.covered.at<std::uint8_t>(y, x) || other.covered.at<std::uint8_t>(y, x)) continue;
        const float p = root_at(a, y, x)[c];
        if (p > 0.08f) ratios.push_back(double(root_at(b, y, x)[c] / p));
      }
    if (ratios.size() >= 50) gain[c] = float(std::clamp(median(std::move(ratios)), 0.5, 2.0));
  }
  return gain;
}

class StillSearch {
 public:
  explicit StillSearch(const StillPhotographs& photographs) : photos_(photographs) {
    const double all = double(photos_.count) * photos_.width * photos_.height;
    const double scale = std::sqrt(std::min(1.0, photos_.held / std::max(1.0, all)));
    size_ = {std::max(1, int(photos_.width * scale)), std::max(1, int(photos_.height * scale))};
  }

  StillBackground run(bool model) {
    read();
    judge();
    if (out_.stillness != Stillness::kStill || !model) return out_;
    find_medians();
    average();
    return out_;
  }

 private:
  cv::Mat roots(std::size_t k) const {
    const ColourImage image = photos_.image(k);
    PHOTOHULL_CHECK_OP(image.width, ==, photos_.width);
    PHOTOHULL_CHECK_OP(image.height, ==, photos_.height);
    return light_roots(image);
  }

  bool whole() const { return size_ == cv::Size(photos_.width, photos_.height); }

  void read() {
    samples_.resize(photos_.count);
    const auto read = [&](std::size_t k) {
      Sample& sample = samples_[k];
      cv::Mat light = roots(k);
      if (!whole()) cv::resize(light, light, size_, 0, 0, cv::INTER_AREA);
      light.convertTo(sample.light, CV_16UC3, double(kMaxCode));
      sample.covered = covered_by(photos_.look(k, size_.width, size_.height));
      cover_object(photos_.mask(k), sample.covered);
    };
    for_photographs(photos_.count, double(photos_.width) * photos_.height, read,
                    [&](std::size_t done) {
                      photos_.progress(double(done) / double(photos_.count) * (whole() ? 1 : 0.5));
                    });
    for_photographs(samples_.size(), double(size_.area()), [&](std::size_t k) {
      if (k > 0) samples_[k].gain = gain_between(samples_[0], samples_[k]);
    });
    for (Sample& s : samples_)
      cv::multiply(s.light, cv::Scalar(1 / s.gain[0], 1 / s.gain[1], 1 / s.gain[2]), s.light);
  }

  // Is it still?

  /// Slopes of a smoothed photograph (CV_32FC2), and where neither page nor box is near (CV_8U).
  struct Slopes {
    cv::Mat slope, free;
  };

  Slopes slopes_of(const Sample& sample) const {
    const double scale = std::min(1.0, double(kJudgedWidth) / size_.width);
    cv::Mat grey, small, dx, dy;
    sample.light.convertTo(small, CV_32F, 1 / double(kMaxCode));
    cv::cvtColor(small, grey, cv::COLOR_RGB2GRAY);
    Slopes out;
    out.free = sample.covered == 0;
    if (scale < 1) {
      cv::resize(grey, grey, {}, scale, scale, cv::INTER_AREA);
      cv::resize(out.free, out.free, grey.size(), 0, 0, cv::INTER_AREA);
      out.free = out.free == 255;
    }
    cv::GaussianBlur(grey, grey, {}, 1);
    cv::erode(out.free, out.free, cv::getStructuringElement(cv::MORPH_RECT, {9, 9}));
    cv::Sobel(grey, dx, CV_32F, 1, 0, 3, 0.125);
    cv::Sobel(grey, dy, CV_32F, 0, 1, 3, 0.125);
    cv::merge(std::vector<cv::Mat>{dx, dy}, out.slope);
    return out;
  }

  void judge() {
    double edges = 0, kept = 0, pixels = 0;
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const Slopes a = slopes_of(samples_[k]),
                   b = slopes_of(samples_[(k + samples_.size() / 2) % samples_.size()]);
      pixels += double(a.free.total());
      for (int y = 0; y < a.free.rows; ++y)
        for (int x = 0; x < a.free.cols; ++x) {
          if (!a.free.at<std::uint8_t>(y, x) || !b.free.at<std::uint8_t>(y, x)) continue;
          const cv::Vec2f g = a.slope.at<cv::Vec2f>(y, x), h = b.slope.at<cv::Vec2f>(y, x);
          const float larger = std::sqrt(std::max(g.dot(g), h.dot(h)));
          if (larger < kLeastEdge) continue;
          ++edges;
          kept += std::sqrt((g - h).dot(g - h)) < kSameEdge * larger;
        }
    }
    if (edges < kFewestEdges * pixels) return;
    out_.edges_kept = kept / edges;
    out_.stillness = out_.edges_kept > kStillShare ? Stillness::kStill : Stillness::kChanges;
  }

  // The model

  /// Light of a pixel in the photographs that tell it.
  struct Pixel {
    std::vector<cv::Vec3f> light;
    std::vector<const Sample*> samples;  ///< of each
    bool free = false;                   ///< the box does not cover it in them
  };

  void take(int y, int x, Pixel& pixel) const {
    pixel.light.clear(), pixel.samples.clear();
    int free = 0;
    for (const Sample& s : samples_) free += s.covered.at<std::uint8_t>(y, x) == 0;
    pixel.free = free >= kFewest;
    for (const Sample& s : samples_)
      if (told(s, y, x, pixel.free)) {
        pixel.light.push_back(root_at(s.light, y, x));
        pixel.samples.push_back(&s);
      }
  }

  static bool told(const Sample& sample, int y, int x, bool free) {
    return (sample.covered.at<std::uint8_t>(y, x) &
            (free ? kPage | kBox | kObject : kPage | kObject)) == 0;
  }

  void find_medians() {
    median_.create(size_, CV_32FC3);
    deviation_ = cv::Mat(size_, CV_32F, cv::Scalar(INFINITY));
    level_ = cv::Mat(size_, CV_8U, cv::Scalar(StillBackground::kUnknown));
    free_ = cv::Mat(size_, CV_8U, cv::Scalar(0));
    tbb::parallel_for(0, size_.height, [&](int y) {
      Pixel pixel;
      for (int x = 0; x < size_.width; ++x) {
        take(y, x, pixel);
        if (pixel.free) set_median(pixel, y, x);
      }
    });
    std::vector<double> usual;
    for (int y = 0; y < size_.height; y += 3)
      for (int x = 0; x < size_.width; x += 3)
        if (free_.at<std::uint8_t>(y, x)) usual.push_back(double(deviation_.at<float>(y, x)));
    noise_ = std::max(0.003f, float(median(std::move(usual))));
    tbb::parallel_for(0, size_.height, [&](int y) {
      Pixel pixel;
      for (int x = 0; x < size_.width; ++x) {
        if (free_.at<std::uint8_t>(y, x)) {
          if (deviation_.at<float>(y, x) < kMostDeviation)
            level_.at<std::uint8_t>(y, x) = StillBackground::kSure;
          continue;
        }
        take(y, x, pixel);
        if (int(pixel.light.size()) >= kFewest) find_alike(pixel, y, x);
      }
    });
  }

  void set_median(const Pixel& pixel, int y, int x) {
    std::vector<float> values(pixel.light.size());
    cv::Vec3f& usual = median_.at<cv::Vec3f>(y, x);
    for (int c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = pixel.light[i][c];
      usual[c] = middle_of(values);
    }
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = difference(pixel.light[i], usual);
    deviation_.at<float>(y, x) = 1.483f * middle_of(values);
    free_.at<std::uint8_t>(y, x) = pixel.free ? 255 : 0;
  }

  /// Light of a pixel that the object may cover in all photographs: what turns shows something else
  /// in each of them, so that those whose surroundings of the pixel are alike show the background.
  /// Nothing is known where there are several such groups, for one of them may be a plain object,
  /// nor of a group of less than half without others that differ.
  void find_alike(Pixel& pixel, int y, int x) {
    const std::size_t n = pixel.light.size();
    std::vector<std::vector<std::size_t>> alike(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        if (windows_agree(pixel, i, j, y, x)) alike[i].push_back(j), alike[j].push_back(i);
    const std::size_t first =
        std::size_t(std::ranges::max_element(alike, {}, [](const auto& a) { return a.size(); }) -
                    alike.begin());
    std::vector<bool> in(n, false);
    in[first] = true;
    for (const std::size_t i : alike[first]) in[i] = true;
    if (int(alike[first].size()) + 1 < kFewest || another_group(alike, in)) return;
    Pixel group;
    for (std::size_t i = 0; i < n; ++i)
      if (in[i]) group.light.push_back(pixel.light[i]);
    set_median(group, y, x);
    std::size_t others = 0;
    for (const cv::Vec3f& light : pixel.light)
      others += difference(light, median_.at<cv::Vec3f>(y, x)) > std::max(kDiffers, 7 * noise_);
    if (others >= 2)
      level_.at<std::uint8_t>(y, x) = StillBackground::kSure;
    else if (2 * group.light.size() > n)
      level_.at<std::uint8_t>(y, x) = StillBackground::kDoubtful;
  }

  /// Are there more that are alike, and not like most of those that are in: three, or half as many?
  static bool another_group(const std::vector<std::vector<std::size_t>>& alike,
                            const std::vector<bool>& in) {
    const auto is_in = [&](std::size_t j) { return in[j]; };
    const auto size = std::ranges::count(in, true);
    for (std::size_t i = 0; i < alike.size(); ++i) {
      const auto inside = std::ranges::count_if(alike[i], is_in);
      const auto outside = std::ptrdiff_t(alike[i].size()) - inside;
      if (in[i] || 2 * inside >= size) continue;
      if (outside > 0 && (outside + 1 >= kOther || 2 * (outside + 1) >= size)) return true;
    }
    return false;
  }

  /// Do two photographs show the same around the pixel, beside the page?
  bool windows_agree(const Pixel& pixel, std::size_t i, std::size_t j, int y, int x) const {
    const float limit = std::max(kAgrees, 4 * noise_);
    if (difference(pixel.light[i], pixel.light[j]) > limit) return false;
    const Sample &a = *pixel.samples[i], &b = *pixel.samples[j];
    int count = 0, agreeing = 0;
    for (int v = std::max(0, y - kWindow); v <= std::min(size_.height - 1, y + kWindow); ++v)
      for (int u = std::max(0, x - kWindow); u <= std::min(size_.width - 1, x + kWindow); ++u) {
        if ((a.covered.at<std::uint8_t>(v, u) | b.covered.at<std::uint8_t>(v, u)) & kPage) continue;
        ++count;
        agreeing += difference(root_at(a.light, v, u), root_at(b.light, v, u)) < limit;
      }
    return count >= kFewestInWindow && agreeing > kAgreeing * count;
  }

  /// Full-sized light: the mean of the photographs that have what the median has.
  void average() {
    const int w = photos_.width, h = photos_.height;
    cv::Mat sum(h, w, CV_32FC3, cv::Scalar::all(0)), count(h, w, CV_16U, cv::Scalar(0));
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      cv::Mat agrees = agreeing(samples_[k]), light;
      if (whole()) {
        samples_[k].light.convertTo(light, CV_32F, 1 / double(kMaxCode));
      } else {
        const cv::Vec3f& g = samples_[k].gain;
        light = roots(k);
        cv::multiply(light, cv::Scalar(1 / g[0], 1 / g[1], 1 / g[2]), light);
        cv::resize(agrees, agrees, {w, h}, 0, 0, cv::INTER_NEAREST);
        photos_.progress(0.5 + 0.5 * (double(k) + 1) / double(photos_.count));
      }
      cv::add(sum, light, sum, agrees);
      cv::add(count, cv::Scalar(1), count, agrees);
    }
    cv::Mat level, deviation;
    cv::resize(level_, level, {w, h}, 0, 0, cv::INTER_NEAREST);
    cv::resize(deviation_, deviation, {w, h}, 0, 0, cv::INTER_NEAREST);
    write(sum, count, level, deviation);
  }

  cv::Mat agreeing(const Sample& sample) const {
    cv::Mat out(size_, CV_8U, cv::Scalar(0));
    tbb::parallel_for(0, size_.height, [&](int y) {
      for (int x = 0; x < size_.width; ++x) {
        if (!level_.at<std::uint8_t>(y, x)) continue;
        if (!told(sample, y, x, free_.at<std::uint8_t>(y, x) != 0)) continue;
        const float limit = 3 * std::max(noise_, deviation_.at<float>(y, x));
        if (difference(root_at(sample.light, y, x), median_.at<cv::Vec3f>(y, x)) <= limit)
          out.at<std::uint8_t>(y, x) = 255;
      }
    });
    return out;
  }

  void write(const cv::Mat& sum, const cv::Mat& count, const cv::Mat& level,
             const cv::Mat& deviation) {
    out_.width = sum.cols, out_.height = sum.rows;
    const std::size_t pixels = sum.total();
    out_.light.resize(3 * pixels), out_.deviation.resize(pixels), out_.level.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      const int y = int(i / std::size_t(sum.cols)), x = int(i % std::size_t(sum.cols));
      const int n = count.at<std::uint16_t>(y, x);
      if (n == 0) continue;
      for (int c = 0; c < 3; ++c)
        out_.light[3 * i + std::size_t(c)] = std::uint16_t(
            std::lround(std::clamp(sum.at<cv::Vec3f>(y, x)[c] / float(n), 0.0f, 1.0f) * kMaxCode));
      out_.level[i] = level.at<std::uint8_t>(y, x);
      out_.deviation[i] = std::uint8_t(
          std::lround(std::min(255.0f, 1000 * std::max(noise_, deviation.at<float>(y, x)))));
    }
  }

  const StillPhotographs& photos_;
  cv::Size size_;  ///< of the samples
  std::vector<Sample> samples_;
  cv::Mat median_, deviation_, level_, free_;  ///< CV_32FC3, CV_32F, CV_8U, CV_8U
  float noise_ = 0;                            ///< of the background, roots of light
  StillBackground out_;
};

}  // namespace

StillBackground find_still_background(const StillPhotographs& photographs, bool model) {
  PHOTOHULL_CHECK_OP(photographs.count, >=, std::size_t(2));
  return StillSearch(photographs).run(model);
}

}  // namespace photohull
