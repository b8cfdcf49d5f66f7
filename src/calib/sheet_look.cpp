#include "calib/sheet_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "calib/board_model.h"
#include "core/error.h"
#include "sheet/bend_sheet.h"
#include "sheet/meet_sheet.h"

namespace photohull {
namespace {

constexpr int kSamples = 2;  // along each side of a pixel
// Pixels between which undistorted places are interpolated: in the corner of a photograph of 640
// pixels by a lens of 500, with k1 of -0.15, that puts them 0.015 pixels off.
constexpr int kStep = 4;

/// Lines of sight of one photograph, in millimetres of the sheet's frame.
class Sight {
 public:
  Sight(const PoseResult& result, std::size_t photo, const Sheet& sheet)
      : camera_(result.cameras[std::size_t(result.photos[photo].camera)]),
        pose_(result.photos[photo].cam_from_world),
        scale_(result.scale),
        model_(model_of(camera_.distortion)),
        lens_(lens_of({camera_.intrinsics, camera_.distortion})),
        reach_(0.5 * glm::length(sheet.page)),
        to_world_(glm::transpose(result.photos[photo].cam_from_world.rotation)),
        eye_(-(to_world_ * result.photos[photo].cam_from_world.translation) / result.scale),
        low_(result.box.min / result.scale),
        high_(result.box.max / result.scale) {
    const SheetBend& b = result.bend;
    bend_ = glm::dvec3(b.xx, b.xy, b.yy) * (result.scale * reach_ * reach_);
  }

  int width() const { return camera_.intrinsics.width; }
  int height() const { return camera_.intrinsics.height; }

  std::vector<glm::dvec2> undistorted_pixels(const std::vector<glm::dvec2>& pixels) const {
    return undistorted(pixels, model_, lens_);
  }

  glm::dvec3 direction(const glm::dvec2& p) const { return to_world_ * glm::dvec3(p, 1.0); }

  /// The place of the sheet that is seen there.
  std::optional<glm::dvec2> place(const glm::dvec2& p) const {
    const auto hit = meet_sheet(eye_, direction(p), bend_, reach_);
    return hit ? std::optional(hit->place) : std::nullopt;
  }

  const glm::dvec3& eye() const { return eye_; }

  /// Of a place of the sheet, in its frame.
  glm::dvec3 raised(const glm::dvec2& place) const {
    glm::dvec3 p(place, 0);
    if (bend_ != glm::dvec3(0.0)) bend_sheet(&bend_.x, reach_, &p.x);
    return p;
  }

  std::optional<glm::dvec2> pixel(const glm::dvec2& place) const {
    const glm::dvec3 p = pose_.rotation * (scale_ * raised(place)) + pose_.translation;
    if (!(p.z > 0)) return std::nullopt;
    glm::dvec2 pixel{0.0};
    project(model_, lens_.data(), &p.x, &pixel.x);
    return pixel;
  }

  /// Does the line of sight pass through the box?
  bool meets_box(const glm::dvec2& p) const { return line_meets_box(direction(p)); }
  bool line_meets_box(const glm::dvec3& d) const {
    double first = 0, last = INFINITY;
    for (int i = 0; i < 3; ++i) {
      const double a = (low_[i] - eye_[i]) / d[i], b = (high_[i] - eye_[i]) / d[i];
      if (std::isnan(a) || std::isnan(b)) continue;
      first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
    }
    return first <= last;
  }

 private:
  PosedCamera camera_;
  Pose pose_;
  double scale_;
  LensModel model_;
  Lens lens_;
  double reach_;
  glm::dmat3 to_world_;
  glm::dvec3 eye_, low_, high_, bend_{0.0};
};

/// The corners of a photograph's pixels, undistorted, from those of every kStep-th.
class PixelCorners {
 public:
  explicit PixelCorners(const Sight& sight) : width_(sight.width()), columns_(width_ / kStep + 2) {
    std::vector<glm::dvec2> pixels;
    for (int y = 0; y < sight.height() + kStep + 1; y += kStep)
      for (int x = 0; x < columns_; ++x) pixels.emplace_back(x * kStep - 0.5, y - 0.5);
    knots_ = sight.undistorted_pixels(pixels);
  }

  /// Of a row's pixels, at its upper edge: between the rows y - 1 and y.
  std::vector<glm::dvec2> above(int y) const {
    const glm::dvec2* upper = &knots_[std::size_t(y / kStep) * std::size_t(columns_)];
    const double v = double(y % kStep) / kStep;
    std::vector<glm::dvec2> out;
    for (int x = 0; x <= width_; ++x) {
      const int i = x / kStep;
      const double u = double(x % kStep) / kStep;
      out.push_back(glm::mix(glm::mix(upper[i], upper[i + 1], u),
                             glm::mix(upper[i + columns_], upper[i + columns_ + 1], u), v));
    }
    return out;
  }

 private:
  int width_, columns_;
  std::vector<glm::dvec2> knots_;
};

/// What is seen at the corners of a row's pixels.
struct CornerRow {
  std::vector<glm::dvec2> corners;                ///< undistorted
  std::vector<std::optional<glm::dvec2>> places;  ///< of the sheet

  CornerRow(const Sight& sight, std::vector<glm::dvec2> row) : corners(std::move(row)) {
    for (const glm::dvec2& corner : corners) places.push_back(sight.place(corner));
  }
};

/// The mean over a pixel's area. The places of the sheet at its corners are given row by row;
/// within a pixel they are as good as linear.
void add_pixel(const SheetPicture& picture, const SheetLight& light,
               const std::array<std::optional<glm::dvec2>, 4>& places, SheetLook& look) {
  const bool hit = places[0] && places[1] && places[2] && places[3];
  float sum = 0;
  bool beside = false, agreed = true;
  glm::vec3 paper(0.0f);
  for (int k = 0; k < kSamples * kSamples; ++k) {
    const double u = (k % kSamples + 0.5) / kSamples, v = (k / kSamples + 0.5) / kSamples;
    const glm::dvec2 place =
        hit ? glm::mix(glm::mix(*places[0], *places[1], u), glm::mix(*places[2], *places[3], u), v)
            : glm::dvec2(0.0);
    const float own = hit ? picture.at(place) : -1;
    beside = beside || own < 0;
    sum += own / (kSamples * kSamples);
    if (beside || light.empty()) continue;
    const SheetLight::Texel texel = light.at(place);
    paper += texel.paper / float(kSamples * kSamples);
    agreed = agreed && texel.agreed;
  }
  look.light.push_back(beside ? -1 : sum);
  if (light.empty()) return;
  look.paper.push_back(beside ? glm::vec3(0.0f) : paper);
  look.agreed.push_back(!beside && agreed ? 255 : 0);
}

/// The blur of every pixel (CV_32F): the mean of all places' by their nearness, squared.
cv::Mat blur_field(std::span<const LocalBlur> blur, const cv::Size& size) {
  constexpr int kCoarse = 16;  // pixels, between which it is interpolated
  const double near = std::pow(0.05 * std::hypot(size.width, size.height), 2);
  cv::Mat coarse(size.height / kCoarse + 2, size.width / kCoarse + 2, CV_32F), field;
  for (int y = 0; y < coarse.rows; ++y)
    for (int x = 0; x < coarse.cols; ++x) {
      double sum = 0, weights = 0;
      for (const LocalBlur& b : blur) {
        const glm::dvec2 away = b.at - (double(kCoarse) * (glm::dvec2(x, y) + 0.5) - 0.5);
        const double weight = 1 / (near + glm::dot(away, away));
        sum += weight * b.deviation, weights += weight;
      }
      coarse.at<float>(y, x) = float(sum / weights);
    }
  cv::resize(coarse, field, {}, kCoarse, kCoarse, cv::INTER_LINEAR);
  return field(cv::Rect({}, size)).clone();
}

/// Blurs an image (CV_32F) by Gaussians with these deviations, between `least` and `most`.
void blur_by(const cv::Mat& field, double least, double most, cv::Mat& image) {
  constexpr double kApart = 0.3;  // pixels, between deviations whose images are mixed
  const int steps = std::max(1, int(std::ceil((most - least) / kApart)));
  cv::Mat out(image.size(), CV_32F, cv::Scalar(0)), blurred;
  for (int i = 0; i <= steps; ++i) {
    const double deviation = least + (most - least) * i / steps;
    if (deviation > 0)
      cv::GaussianBlur(image, blurred, {}, deviation);
    else
      blurred = image;
    const cv::Mat share = 1 - cv::min(cv::abs(field - deviation) * (steps / (most - least)), 1);
    out += share.mul(blurred);
  }
  out.copyTo(image);
}

/// Blurs what is seen of the page; pixels beside it reach into it by twice the blur. The light
/// comes from photographs and is as blurred as they are.
void blur_look(std::span<const LocalBlur> blur, SheetLook& look) {
  constexpr double kSame = 0.05;  // pixels
  const auto [least, most] = std::ranges::minmax(blur, {}, &LocalBlur::deviation);
  if (!(most.deviation > 0)) return;
  cv::Mat light(look.height, look.width, CV_32F, look.light.data());
  const cv::Mat beside = light < 0;
  light.setTo(1, beside);
  if (most.deviation - least.deviation < kSame)
    cv::GaussianBlur(light, light, {}, most.deviation);
  else
    blur_by(blur_field(blur, light.size()), least.deviation, most.deviation, light);
  cv::Mat near;
  const int reach = 2 * int(std::ceil(2 * most.deviation)) + 1;
  cv::dilate(beside, near, cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
  light.setTo(-1, near);
  look.mixed = reach + 1;
}

}  // namespace

std::vector<LocalBlur> blur_of_edges(std::span<const EdgeWidth> edges, double scale) {
  constexpr double kBox = 1 / 12.0;  // variance of a pixel's area
  std::vector<LocalBlur> out;
  for (const EdgeWidth& edge : edges) {
    const double sigma = scale * edge.width / 1.68;
    out.push_back({scale * edge.at, std::sqrt(std::max(0.0, sigma * sigma - kBox))});
  }
  return out;
}

SheetLook look_at_sheet(const PoseResult& result, std::size_t photo, const Sheet& sheet,
                        const SheetPicture& picture, std::span<const LocalBlur> blur,
                        const SheetLight& light) {
  PHOTOHULL_CHECK(result.photos[photo].posed);
  const Sight sight(result, photo, sheet);
  SheetLook look;
  look.width = sight.width(), look.height = sight.height();
  look.steady = light.steady;
  const PixelCorners corners(sight);
  CornerRow above(sight, corners.above(0));
  for (int y = 0; y < look.height; ++y) {
    CornerRow below(sight, corners.above(y + 1));
    for (std::size_t x = 0; x < std::size_t(look.width); ++x) {
      add_pixel(picture, light,
                {above.places[x], above.places[x + 1], below.places[x], below.places[x + 1]}, look);
      look.possible.push_back(sight.meets_box(0.5 * (above.corners[x] + below.corners[x + 1])) ? 255
                                                                                               : 0);
    }
    above = std::move(below);
  }
  if (!blur.empty()) blur_look(blur, look);
  return look;
}

SheetSight sight_of_sheet(const PoseResult& result, std::size_t photo, const Sheet& sheet) {
  PHOTOHULL_CHECK(result.photos[photo].posed);
  const Sight sight(result, photo, sheet);
  return {sight.eye(), [sight](const glm::dvec2& place) { return sight.pixel(place); },
          [sight](const glm::dvec2& place) {
            return sight.line_meets_box(sight.raised(place) - sight.eye());
          }};
}

}  // namespace photohull
