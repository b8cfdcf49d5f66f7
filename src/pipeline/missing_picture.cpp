#include "pipeline/missing_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/photographed.h"
#include "masks/silhouette.h"
#include "raycast/ray_scene.h"

namespace photohull::pipeline {
namespace {

constexpr double kTolerance = 2;    // pixels beside a contour that do not count
constexpr double kDarkened = 0.45;  // of the photograph's light
constexpr std::uint8_t kRed[3] = {255, 40, 30}, kBlue[3] = {40, 110, 255};

}  // namespace

MissingPicture draw_missing(const CheckedResult& result,
                            std::span<const assess::SilhouetteFit> fits) {
  const auto worst = std::max_element(fits.begin(), fits.end(), [](const auto& a, const auto& b) {
    return (a.foreground > 0 ? a.missed : -1) < (b.foreground > 0 ? b.missed : -1);
  });
  if (worst == fits.end() || worst->foreground == 0) return {};
  const auto v = std::size_t(worst - fits.begin());
  const PreparedView& view = result.views[v];
  const SilhouetteDistance& used = view.silhouette.distance;
  SilhouetteDistance own;
  if (!view.silhouette.widened.empty()) own = silhouette_distance(view.mask);
  const SilhouetteDistance& given = own.pixels.empty() ? used : own;

  MissingPicture picture{{used.width, used.height, {}}, view.name};
  const RayScene rays(*result.mesh);
  picture.rgb.resize(3 * used.pixels.size());
  const glm::dvec3 origin = view.camera.center();
  tbb::parallel_for(0, used.height, [&](int y) {
    for (int x = 0; x < used.width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(used.width) + x;
      const bool hit = rays.occluded(origin, view.camera.ray({x, y}));
      const glm::vec4 light = view.image.linear(x, y);
      const bool missed =
          given.pixels[i] < -kTolerance && !hit && is_photographed(view.image, x, y);
      const bool excess = used.pixels[i] > kTolerance && hit;
      for (int c = 0; c < 3; ++c)
        picture.rgb[3 * i + std::size_t(c)] =
            missed   ? kRed[c]
            : excess ? kBlue[c]
                     : std::uint8_t(std::lround(
                           255 * srgb_from_linear(kDarkened * std::clamp(light[c], 0.0f, 1.0f))));
    }
  });
  for (const LinePoint& p : view.silhouette.lines) {
    if (assess::covers_line(rays, view.camera, p, kTolerance)) continue;
    const int x = std::clamp(int(std::lround(p.x)), 0, used.width - 1);
    const int y = std::clamp(int(std::lround(p.y)), 0, used.height - 1);
    std::copy_n(kRed, 3, &picture.rgb[3 * (std::size_t(y) * std::size_t(used.width) + x)]);
  }
  return picture;
}

}  // namespace photohull::pipeline
