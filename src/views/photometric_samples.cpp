#include "views/photometric_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <optional>

#include "core/error.h"
#include "raycast/ray_scene.h"
#include "views/undistort.h"

namespace photohull {
namespace {

constexpr double kLeastCosine = 0.4;      // flatter views see gloss and mix neighbours
constexpr int kLargestWindow = 6;         // pixels to each side
constexpr int kMaskMargin = 2;            // pixels around the window
constexpr std::uint8_t kInside = 250;     // coverage
constexpr float kSaturated = 0.96f;       // linear light; sRGB 250 of 255
constexpr double kLeastLight = 0.006;     // linear light; darker colours are mostly noise and veil
constexpr double kModelSigma = 0.01;      // of a logarithm: what the model leaves out at best
constexpr double kTextureShare = 0.25;    // of the window's contrast: surface and pose are inexact
constexpr int kClusterCells = 6;          // along the mesh's longest side
constexpr double kFocalTolerance = 0.01;  // of lenses that are one

const std::array<float, 256>& linear_of_code() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < 256; ++i) t[i] = float(linear_from_srgb(double(i) / 255));
    return t;
  }();
  return table;
}

/// 8-bit codes of 65536 steps of linear light.
const std::vector<std::uint8_t>& code_of_linear() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> t(65536);
    for (std::size_t i = 0; i < t.size(); ++i)
      t[i] = std::uint8_t(std::lround(255 * srgb_from_linear(double(i) / 65535)));
    return t;
  }();
  return table;
}

glm::vec4 pixel(const ColourImage& image, int x, int y) {
  if (image.encoding != ColourImage::Encoding::kSrgb8) return image.linear(x, y);
  const std::uint8_t* p =
      &image.bytes[4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x))];
  const auto& linear = linear_of_code();
  return {linear[p[0]], linear[p[1]], linear[p[2]], float(p[3]) / 255};
}

/// Is everything within `reach` pixels on the image and inside the object?
bool inside(const PreparedView& view, const glm::ivec2& at, int reach) {
  if (at.x < reach || at.y < reach || at.x >= view.image.width - reach ||
      at.y >= view.image.height - reach)
    return false;
  if (view.mask.empty()) return true;
  for (int y = at.y - reach; y <= at.y + reach; ++y)
    for (int x = at.x - reach; x <= at.x + reach; ++x)
      if (view.mask.coverage[std::size_t(y) * std::size_t(view.mask.width) + std::size_t(x)] <
          kInside)
        return false;
  return true;
}

/// Mean colour of a window and its deviation; nothing where a pixel is unknown or saturated.
std::optional<PhotometricSample> read_window(const PreparedView& view, const glm::dvec2& at,
                                             int reach, double noise_sigma) {
  const glm::ivec2 middle(glm::floor(at + 0.5));
  if (!inside(view, middle, reach + kMaskMargin)) return {};
  glm::dvec3 sum(0), squares(0);
  for (int y = middle.y - reach; y <= middle.y + reach; ++y)
    for (int x = middle.x - reach; x <= middle.x + reach; ++x) {
      const glm::vec4 p = pixel(view.image, x, y);
      if (p.a < 0.999f || p.r > kSaturated || p.g > kSaturated || p.b > kSaturated) return {};
      const glm::dvec3 c(p);
      sum += c, squares += c * c;
    }
  const double count = (2 * reach + 1) * (2 * reach + 1);
  PhotometricSample sample;
  sample.colour = sum / count;
  for (int c = 0; c < 3; ++c) {
    const double light = sample.colour[c];
    if (!(light > kLeastLight)) {  // decided for the whole point later
      sample.sigma[c] = 0;
      continue;
    }
    const double contrast = std::max(0.0, squares[c] / count / (light * light) - 1);
    // The noise is that of square roots: d log L = 2 d sqrt(L) / sqrt(L).
    const double noise = 4 * noise_sigma * noise_sigma / light / count;
    sample.sigma[c] =
        std::sqrt(kModelSigma * kModelSigma + noise + kTextureShare * kTextureShare * contrast);
  }
  return sample;
}

struct Extent {
  glm::vec3 low{0}, high{0};
  int cluster(const glm::vec3& p) const {
    const glm::vec3 size = high - low;
    const float edge = std::max({size.x, size.y, size.z, 1e-30f}) / kClusterCells;
    const glm::ivec3 cell = glm::min(glm::ivec3((p - low) / edge), glm::ivec3(kClusterCells - 1));
    return (cell.z * kClusterCells + cell.y) * kClusterCells + cell.x;
  }
};

Extent extent_of(const TriMesh& mesh) {
  Extent e{mesh.positions[0], mesh.positions[0]};
  for (const glm::vec3& p : mesh.positions) {
    e.low = glm::min(e.low, p);
    e.high = glm::max(e.high, p);
  }
  return e;
}

/// The factor by which a pixel of the view is too bright.
class Factor {
 public:
  Factor(const ViewGain& gain, double vignetting, const PhotometricFrame& frame,
         const Intrinsics& view)
      : gain_(gain.solved ? gain.gain : glm::dvec3(1)),
        vignetting_(vignetting),
        frame_(frame),
        view_(view) {}

  bool none() const { return vignetting_ == 0 && gain_ == glm::dvec3(1); }
  glm::vec3 at(int x, int y) const {
    if (vignetting_ == 0) return glm::vec3(gain_);
    // Undistortion shows more than the frame held, as unknown pixels.
    const double r2 = std::min(frame_.radius2(view_, {x, y}), 1.0);
    return glm::vec3(gain_ * (1 - vignetting_ * r2));
  }

 private:
  glm::dvec3 gain_;
  double vignetting_;
  const PhotometricFrame& frame_;
  const Intrinsics& view_;
};

void correct_row(const Factor& factor, int y, ColourImage& image) {
  const auto& linear = linear_of_code();
  const auto& code = code_of_linear();
  std::uint8_t* row =
      &image.bytes[std::size_t(y) * std::size_t(image.width) * image.bytes_per_pixel()];
  for (int x = 0; x < image.width; ++x) {
    const glm::vec3 f = factor.at(x, y);
    if (image.encoding == ColourImage::Encoding::kSrgb8) {
      std::uint8_t* p = row + std::size_t(x) * 4;
      for (int c = 0; c < 3; ++c)
        p[c] = code[std::size_t(std::lround(65535 * std::min(1.0f, linear[p[c]] / f[c])))];
    } else {
      std::uint16_t half[3];
      std::memcpy(half, row + std::size_t(x) * 8, sizeof half);
      constexpr float kLargestHalf = 65504;
      for (int c = 0; c < 3; ++c)
        half[c] = glm::packHalf1x16(std::min(glm::unpackHalf1x16(half[c]) / f[c], kLargestHalf));
      std::memcpy(row + std::size_t(x) * 8, half, sizeof half);
    }
  }
}

}  // namespace

double PhotometricFrame::radius2(const Intrinsics& view, const glm::dvec2& p) const {
  const double y = (p.y - view.cy) / view.fy;
  const double x = (p.x - view.cx - view.skew * y) / view.fx;
  const glm::dvec2 d =
      distortion.model == DistortionModel::kNone ? glm::dvec2(x, y) : distort(distortion, {x, y});
  const Intrinsics& k = intrinsics;
  const glm::dvec2 file(k.fx * d.x + k.skew * d.y + k.cx, k.fy * d.y + k.cy);
  const glm::dvec2 middle(0.5 * (k.width - 1), 0.5 * (k.height - 1));
  return glm::dot(file - middle, file - middle) / std::max(glm::dot(middle, middle), 1.0);
}

std::vector<PhotometricFrame> frames_of(std::span<const PreparedView> views) {
  std::vector<PhotometricFrame> frames;
  for (const PreparedView& view : views)
    frames.push_back({view.source.camera.intrinsics, view.source.distortion});
  return frames;
}

std::vector<int> shared_lenses(std::span<const PhotometricFrame> frames) {
  std::vector<int> lenses;
  std::vector<const Intrinsics*> first;
  for (const PhotometricFrame& frame : frames) {
    const Intrinsics& k = frame.intrinsics;
    const auto same = std::find_if(first.begin(), first.end(), [&](const Intrinsics* f) {
      return f->width == k.width && f->height == k.height &&
             std::abs(f->fx - k.fx) <= kFocalTolerance * f->fx;
    });
    lenses.push_back(int(same - first.begin()));
    if (same == first.end()) first.push_back(&k);
  }
  return lenses;
}

std::vector<PhotometricPoint> sample_photometric(const TriMesh& mesh, double patch,
                                                 std::span<const PreparedView> views,
                                                 std::span<const PhotometricFrame> frames,
                                                 double noise_sigma, const Progress& progress,
                                                 std::size_t most) {
  PHOTOHULL_CHECK_OP(views.size(), ==, frames.size());
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  if (mesh.triangles.empty()) return {};
  const RayScene rays(mesh);
  const Extent extent = extent_of(mesh);
  const std::size_t count = std::min(mesh.positions.size(), most);
  std::vector<PhotometricPoint> points(count);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    progress.check_cancelled();
    const std::size_t vertex = i * mesh.positions.size() / count;
    const glm::dvec3 position = mesh.world(vertex), normal(mesh.normals[vertex]);
    PhotometricPoint& point = points[i];
    point.cluster = extent.cluster(mesh.positions[vertex]);
    if (!(glm::length(normal) > 0.5)) return;
    const glm::dvec3 lifted = position + patch * normal;
    for (std::size_t v = 0; v < views.size(); ++v) {
      const Camera& camera = views[v].camera;
      const glm::dvec3 way = camera.center() - lifted;
      if (!(glm::dot(glm::normalize(camera.center() - position), normal) > kLeastCosine)) continue;
      const auto at = camera.project(position);
      if (!at || !camera.on_image(*at)) continue;
      const double depth = camera.to_camera(position).z;
      const int reach = int(std::clamp(std::round(patch * camera.intrinsics.fx / depth), 1.0,
                                       double(kLargestWindow)));
      auto sample = read_window(views[v], *at, reach, noise_sigma);
      if (!sample || rays.occluded(lifted, way, 0, 1)) continue;
      sample->view = int(v);
      sample->radius2 = frames[v].radius2(camera.intrinsics, *at);
      if (sample->radius2 < 1) point.samples.push_back(*sample);
    }
    // Dropping the dark samples alone would favour the views that have it brighter.
    const bool dark =
        std::any_of(point.samples.begin(), point.samples.end(), [](const PhotometricSample& s) {
          return !(s.sigma.r > 0 && s.sigma.g > 0 && s.sigma.b > 0);
        });
    if (dark) point.samples.clear();
  });
  std::erase_if(points, [](const PhotometricPoint& p) { return p.samples.size() < 2; });
  return points;
}

void apply_photometric(const PhotometricCalibration& calibration,
                       std::span<const PhotometricFrame> frames,
                       const std::vector<int>& lens_of_view, std::span<PreparedView> views) {
  PHOTOHULL_CHECK_OP(views.size(), ==, calibration.views.size());
  PHOTOHULL_CHECK_OP(views.size(), ==, frames.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    const double vignetting = calibration.vignetting[std::size_t(lens_of_view[i])];
    const Factor factor(calibration.views[i], vignetting, frames[i], views[i].camera.intrinsics);
    if (factor.none()) return;
    tbb::parallel_for(0, views[i].image.height,
                      [&](int y) { correct_row(factor, y, views[i].image); });
  });
}

}  // namespace photohull
