#include "calib/sheet_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "calib/board_model.h"
#include "core/error.h"
#include "sheet/bend_sheet.h"
#include "sheet/meet_sheet.h"

namespace photohull {
namespace {

constexpr int kSamples = 2;  // along each side of a pixel

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

  /// At the corners of a row's pixels: between the rows y - 1 and y.
  std::vector<glm::dvec2> corners(int y) const {
    std::vector<glm::dvec2> pixels;
    for (int x = 0; x <= width(); ++x) pixels.emplace_back(x - 0.5, y - 0.5);
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

/// The mean over a pixel's area, whose corners are given row by row.
void add_pixel(const Sight& sight, const SheetPicture& picture, const SheetLight& light,
               const std::array<glm::dvec2, 4>& corners, SheetLook& look) {
  float sum = 0;
  bool beside = false, agreed = true;
  glm::vec3 paper(0.0f);
  for (int k = 0; k < kSamples * kSamples; ++k) {
    const double u = (k % kSamples + 0.5) / kSamples, v = (k / kSamples + 0.5) / kSamples;
    const auto place = sight.place(
        glm::mix(glm::mix(corners[0], corners[1], u), glm::mix(corners[2], corners[3], u), v));
    const float own = place ? picture.at(*place) : -1;
    beside = beside || own < 0;
    sum += own / (kSamples * kSamples);
    if (beside || light.empty()) continue;
    const SheetLight::Texel texel = light.at(*place);
    paper += texel.paper / float(kSamples * kSamples);
    agreed = agreed && texel.agreed;
  }
  look.light.push_back(beside ? -1 : sum);
  if (light.empty()) return;
  look.paper.push_back(beside ? glm::vec3(0.0f) : paper);
  look.agreed.push_back(!beside && agreed ? 255 : 0);
}

/// Blurs what is seen of the page; pixels beside it reach into it by twice the blur. The light
/// comes from photographs and is as blurred as they are.
void blur_look(double blur, SheetLook& look) {
  cv::Mat light(look.height, look.width, CV_32F, look.light.data());
  const cv::Mat beside = light < 0;
  light.setTo(1, beside);
  cv::GaussianBlur(light, light, {}, blur);
  cv::Mat near;
  const int reach = 2 * int(std::ceil(2 * blur)) + 1;
  cv::dilate(beside, near, cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
  light.setTo(-1, near);
  look.mixed = reach + 1;
}

}  // namespace

double blur_of_edges(double edge_width) {
  constexpr double kBox = 1 / 12.0;  // variance of a pixel's area
  const double sigma = edge_width / 1.68;
  return std::sqrt(std::max(0.0, sigma * sigma - kBox));
}

SheetLook look_at_sheet(const PoseResult& result, std::size_t photo, const Sheet& sheet,
                        const SheetPicture& picture, double blur, const SheetLight& light) {
  PHOTOHULL_CHECK(result.photos[photo].posed);
  const Sight sight(result, photo, sheet);
  SheetLook look;
  look.width = sight.width(), look.height = sight.height();
  look.steady = light.steady;
  std::vector<glm::dvec2> above = sight.corners(0);
  for (int y = 0; y < look.height; ++y) {
    const std::vector<glm::dvec2> below = sight.corners(y + 1);
    for (std::size_t x = 0; x < std::size_t(look.width); ++x) {
      add_pixel(sight, picture, light, {above[x], above[x + 1], below[x], below[x + 1]}, look);
      look.possible.push_back(sight.meets_box(0.5 * (above[x] + below[x + 1])) ? 255 : 0);
    }
    above = below;
  }
  if (blur > 0) blur_look(blur, look);
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
