#include "assess/silhouette_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/clip_ray.h"

namespace photohull::assess {
namespace {

constexpr double kRays = 4000;  // a view, about

SilhouetteFit check(const RayScene& rays, const Box& box, const Camera& camera,
                    const SilhouetteDistance& distance, double tolerance) {
  SilhouetteFit fit;
  const double pixels = double(distance.width) * distance.height;
  const int step = std::max(1, int(std::sqrt(pixels / kRays)));
  const glm::dvec3 origin = camera.center();
  int missed = 0, excess = 0;
  for (int y = step / 2; y < distance.height; y += step)
    for (int x = step / 2; x < distance.width; x += step) {
      const double d = distance.pixels[std::size_t(y) * distance.width + x];
      if (std::abs(d) <= tolerance) continue;
      const glm::dvec3 ray = camera.ray({x, y});
      if (!clip_ray(box, origin, ray)) continue;
      const bool hit = rays.occluded(origin, ray);
      fit.covered += hit;
      fit.foreground += d < 0;
      missed += d < 0 && !hit;
      excess += d > 0 && hit;
    }
  if (fit.foreground > 0) fit.missed = double(missed) / fit.foreground;
  if (fit.covered > 0) fit.excess = double(excess) / fit.covered;
  return fit;
}

}  // namespace

std::vector<SilhouetteFit> check_silhouettes(const RayScene& rays, const Box& box,
                                             std::span<const Camera> cameras,
                                             std::span<const SilhouetteDistance* const> silhouettes,
                                             double tolerance) {
  std::vector<SilhouetteFit> fits(cameras.size());
  tbb::parallel_for(std::size_t(0), cameras.size(), [&](std::size_t i) {
    if (silhouettes[i]) fits[i] = check(rays, box, cameras[i], *silhouettes[i], tolerance);
  });
  return fits;
}

}  // namespace photohull::assess
