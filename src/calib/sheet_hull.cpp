// based on: A. Laurentini, The visual hull concept for silhouette-based image understanding, 1994.
#include "calib/sheet_hull.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "calib/board_model.h"
#include "core/error.h"
#include "core/scaled_size.h"

namespace photohull {
namespace {

constexpr int kCells = 96;          // along the box's longest side
constexpr std::size_t kPlenty = 3;  // masks, from which on two must leave a cell out
constexpr double kMargin = 1.5;     // pixels: what masks are off by at their outlines
constexpr std::uint8_t kObject = 128;

/// A ball's picture.
struct Disc {
  glm::dvec2 middle;
  double radius;  ///< pixels
};

class MaskedPhoto {
 public:
  MaskedPhoto(const PoseResult& result, std::size_t photo, const Mask& mask)
      : pose_(result.photos[photo].cam_from_world) {
    const PosedCamera& camera = result.cameras[std::size_t(result.photos[photo].camera)];
    const Intrinsics k = scaled_to(camera.intrinsics, mask.width, mask.height);
    model_ = model_of(camera.distortion);
    lens_ = lens_of({k, camera.distortion});
    frame_ = cv::Rect(0, 0, mask.width, mask.height);
    cv::Mat beside(mask.height, mask.width, CV_8U);
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x)
        beside.at<std::uint8_t>(y, x) =
            mask.coverage[std::size_t(y) * std::size_t(mask.width) + std::size_t(x)] < kObject;
    cv::distanceTransform(beside, distance_, cv::DIST_L2, cv::DIST_MASK_5);
  }

  /// Nothing where the ball does not lie in front of the camera, or its middle not on the image.
  std::optional<Disc> picture(const glm::dvec3& middle, double radius) const {
    const glm::dvec3 p = pose_.rotation * middle + pose_.translation;
    if (!(p.z > 2 * radius)) return std::nullopt;
    Disc disc{};
    project(model_, lens_.data(), &p.x, &disc.middle.x);
    disc.radius = std::max(lens_[0], lens_[1]) * radius / (p.z - radius) + kMargin;
    if (!frame_.contains(pixel(disc))) return std::nullopt;
    return disc;
  }

  bool leaves_out(const glm::dvec3& middle, double radius) const {
    const auto disc = picture(middle, radius);
    return disc && double(distance_.at<float>(pixel(*disc))) > disc->radius;
  }

  void draw(const glm::dvec3& middle, double radius, cv::Mat& shadow) const {
    const auto disc = picture(middle, radius);
    if (disc) cv::circle(shadow, pixel(*disc), int(std::ceil(disc->radius)), 255, cv::FILLED);
  }

  cv::Size size() const { return frame_.size(); }

 private:
  static cv::Point pixel(const Disc& disc) {
    return {int(std::lround(std::clamp(disc.middle.x, -1e6, 1e6))),
            int(std::lround(std::clamp(disc.middle.y, -1e6, 1e6)))};
  }

  Pose pose_;
  LensModel model_;
  Lens lens_;
  cv::Rect frame_;
  cv::Mat distance_;  ///< CV_32F, pixels from each pixel of the background to the object
};

class CoarseHull {
 public:
  CoarseHull(const Box& box, const std::vector<std::optional<MaskedPhoto>>& photos) : box_(box) {
    const glm::dvec3 size = box.size();
    cell_ = std::max({size.x, size.y, size.z}) / kCells;
    n_ = glm::max(glm::ivec3(glm::ceil(size / cell_)), glm::ivec3(1));
    const int enough = photos.size() < kPlenty ? 1 : 2;
    stands_.resize(std::size_t(n_.x) * std::size_t(n_.y) * std::size_t(n_.z));
    tbb::parallel_for(0, n_.z, [&](int z) {
      for (int y = 0; y < n_.y; ++y)
        for (int x = 0; x < n_.x; ++x) {
          int out = 0;
          for (std::size_t i = 0; i < photos.size() && out < enough; ++i)
            out += photos[i]->leaves_out(middle({x, y, z}), radius());
          stands_[index({x, y, z})] = out < enough;
        }
    });
  }

  cv::Mat shadow(const MaskedPhoto& photo) const {
    cv::Mat out(photo.size(), CV_8U, cv::Scalar(0));
    for (int z = 0; z < n_.z; ++z)
      for (int y = 0; y < n_.y; ++y)
        for (int x = 0; x < n_.x; ++x)
          if (on_surface({x, y, z})) photo.draw(middle({x, y, z}), radius(), out);
    return out;
  }

 private:
  glm::dvec3 middle(const glm::ivec3& at) const {
    return box_.min + cell_ * (glm::dvec3(at) + 0.5);
  }
  double radius() const { return 0.5 * std::sqrt(3.0) * cell_; }

  bool stands(const glm::ivec3& at) const {
    if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, n_)))
      return false;
    return stands_[index(at)] != 0;
  }

  std::size_t index(const glm::ivec3& at) const {
    return (std::size_t(at.z) * std::size_t(n_.y) + std::size_t(at.y)) * std::size_t(n_.x) +
           std::size_t(at.x);
  }

  /// What is enclosed casts no shadow of its own.
  bool on_surface(const glm::ivec3& at) const {
    if (!stands(at)) return false;
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        glm::ivec3 beside = at;
        beside[axis] += step;
        if (!stands(beside)) return true;
      }
    return false;
  }

  Box box_;
  double cell_ = 0;
  glm::ivec3 n_{0};
  std::vector<char> stands_;
};

}  // namespace

std::vector<Mask> shadows_of_hull(const PoseResult& result, std::span<const Mask> masks) {
  PHOTOHULL_CHECK_OP(masks.size(), ==, result.photos.size());
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    if (masks[i].empty()) continue;
    PHOTOHULL_CHECK(result.photos[i].posed);
    at.push_back(i);
  }
  std::vector<Mask> shadows(masks.size());
  if (at.empty()) return shadows;
  std::vector<std::optional<MaskedPhoto>> photos(at.size());
  tbb::parallel_for(std::size_t(0), at.size(),
                    [&](std::size_t k) { photos[k].emplace(result, at[k], masks[at[k]]); });
  const CoarseHull hull(result.box, photos);
  tbb::parallel_for(std::size_t(0), at.size(), [&](std::size_t k) {
    const cv::Mat shadow = hull.shadow(*photos[k]);
    shadows[at[k]] = {
        shadow.cols, shadow.rows, {shadow.begin<std::uint8_t>(), shadow.end<std::uint8_t>()}};
  });
  return shadows;
}

}  // namespace photohull
