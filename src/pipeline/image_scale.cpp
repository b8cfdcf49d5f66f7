#include "pipeline/image_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "core/image_scale.h"

namespace photohull::pipeline {
namespace {

constexpr double kFewestPixels = 640.0 * 480.0;
constexpr double kRounding = 1 + 1e-9;  // a voxel of exactly so many pixels has them

/// World size of a pixel of each view's photograph: the larger of the median of all views and that
/// of the views whose photographs are as large.
std::vector<double> pixel_sizes(const Box& box, std::span<const SourceView> views) {
  std::map<std::pair<int, int>, std::vector<Camera>> by_size;
  std::vector<Camera> all;
  for (const SourceView& view : views) {
    const Intrinsics& k = view.camera.intrinsics;
    by_size[{k.width, k.height}].push_back(view.camera);
    all.push_back(view.camera);
  }
  const double median = carving::pixel_footprint(box, all);
  std::map<std::pair<int, int>, double> size_of;
  for (const auto& [size, cameras] : by_size)
    size_of[size] = std::max(median, carving::pixel_footprint(box, cameras));
  std::vector<double> out;
  for (const Camera& camera : all)
    out.push_back(size_of[{camera.intrinsics.width, camera.intrinsics.height}]);
  return out;
}

bool large_enough(const Intrinsics& k, double scale) {
  return k.width * scale * k.height * scale >= kFewestPixels;
}

}  // namespace

std::optional<double> parse_image_scale(const std::string& text) {
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  bool whole = end != text.c_str();
  if (whole && *end == '/') {
    const char* divisor = end + 1;
    value /= std::strtod(divisor, &end);
    whole = end != divisor;
  }
  if (!whole || *end != 0 || !(value > 0 && value <= 1)) return std::nullopt;
  return value;
}

std::string image_scale_text(double scale) {
  const double divisor = 1 / scale;
  if (divisor == std::round(divisor))
    return divisor == 1 ? std::string("1") : concat("1/", std::lround(divisor));
  return concat(scale);
}

std::vector<double> image_scales(const Box& box, std::span<const SourceView> views,
                                 double voxel_size) {
  const std::vector<double> pixels = pixel_sizes(box, views);
  std::vector<double> scales(views.size(), 1.0);
  for (std::size_t i = 0; i < views.size(); ++i)
    while (pixels[i] > 0 && large_enough(views[i].camera.intrinsics, scales[i] / 2) &&
           kPixelsPerVoxel * pixels[i] / (scales[i] / 2) <= voxel_size * kRounding)
      scales[i] /= 2;
  return scales;
}

bool halve_image_scales(const Box& box, std::span<const SourceView> views, double voxel_size,
                        std::vector<double>& scales) {
  const std::vector<double> pixels = pixel_sizes(box, views);
  bool any = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double half = scales[i] / 2;
    if (!large_enough(views[i].camera.intrinsics, half) || !(pixels[i] / half <= voxel_size))
      continue;
    scales[i] = half;
    any = true;
  }
  return any;
}

void keep_unexpected_sizes(const PhotographReader& reader, std::span<const SourceView> views,
                           std::vector<double>& scales) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (scales[i] == 1) continue;
    try {
      const Intrinsics& k = views[i].camera.intrinsics;
      if (reader.size(views[i].image) != glm::ivec2(k.width, k.height)) scales[i] = 1;
    } catch (const Error&) {
      scales[i] = 1;
    }
  }
}

void scale_scene(std::span<const double> scales, Scene& scene) {
  PHOTOHULL_CHECK_OP(scales.size(), ==, scene.views.size());
  for (std::size_t i = 0; i < scales.size(); ++i) {
    Intrinsics& k = scene.views[i].camera.intrinsics;
    k = scaled_intrinsics(k, scales[i]);
  }
  for (SceneTrack& track : scene.tracks)
    for (SceneTrack::Observation& o : track.observations)
      if (const double scale = scales[std::size_t(o.view)]; scale != 1)
        o.pixel = scaled_pixel(o.pixel, scale);
}

}  // namespace photohull::pipeline
