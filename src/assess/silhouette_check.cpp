#include "assess/silhouette_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/clip_ray.h"

namespace photohull::assess {
namespace {

constexpr double kRays = 4000;      // a view, about
constexpr double kLineStep = 0.15;  // pixels across a line: a tube may be a third of a pixel wide

/// Areas in pixels.
struct Areas {
  double foreground = 0, missed = 0, covered = 0, excess = 0;
};

class Checker {
 public:
  Checker(const RayScene& rays, const Box& box, const Camera& camera, double tolerance)
      : rays_(rays), box_(box), camera_(camera), origin_(camera.center()), tolerance_(tolerance) {}

  void look_at_lattice(const CheckedSilhouette& s, SilhouetteFit& fit, Areas& areas) const {
    const SilhouetteDistance& given = *s.given;
    const double pixels = double(given.width) * given.height;
    const int step = std::max(1, int(std::sqrt(pixels / kRays)));
    const double area = double(step) * step;
    for (int y = step / 2; y < given.height; y += step)
      for (int x = step / 2; x < given.width; x += step) {
        const std::size_t i = std::size_t(y) * std::size_t(given.width) + x;
        const bool inside = given.pixels[i] < -tolerance_;
        const bool outside = s.used->pixels[i] > tolerance_;
        if (!inside && !outside) continue;
        const glm::dvec3 ray = camera_.ray({x, y});
        if (!clip_ray(box_, origin_, ray)) continue;
        const bool hit = rays_.occluded(origin_, ray);
        const double sure = sureness(s, i);
        fit.covered += hit, areas.covered += hit ? area : 0;
        fit.foreground += inside, areas.foreground += inside ? sure * area : 0;
        areas.missed += inside && !hit ? sure * area : 0;
        areas.excess += outside && hit ? area : 0;
      }
  }

  void look_at_lines(const CheckedSilhouette& s, SilhouetteFit& fit, Areas& areas) const {
    const std::vector<LinePoint>& lines = *s.lines;
    const int width = s.given->width, height = s.given->height;
    const std::size_t stride = lines.size() / std::size_t(kRays) + 1;
    for (std::size_t i = 0; i < lines.size(); i += stride) {
      const LinePoint& p = lines[i];
      if (!clip_ray(box_, origin_, camera_.ray({p.x, p.y}))) continue;
      const bool hit = covers_line(rays_, camera_, p, tolerance_);
      const int x = std::clamp(int(std::lround(p.x)), 0, width - 1);
      const int y = std::clamp(int(std::lround(p.y)), 0, height - 1);
      const double area =
          sureness(s, std::size_t(y) * std::size_t(width) + x) * double(stride) * p.width;
      ++fit.foreground;
      areas.foreground += area;
      areas.missed += hit ? 0 : area;
    }
  }

 private:
  /// How sure the mask is of its foreground at a pixel, [0, 1].
  static double sureness(const CheckedSilhouette& s, std::size_t i) {
    return s.mask ? std::max(s.mask->coverage[i] / 127.5 - 1, 0.0) : 1;
  }

  const RayScene& rays_;
  const Box& box_;
  const Camera& camera_;
  glm::dvec3 origin_;
  double tolerance_;
};

SilhouetteFit check(const RayScene& rays, const Box& box, const Camera& camera,
                    const CheckedSilhouette& silhouette, double tolerance) {
  SilhouetteFit fit;
  Areas areas;
  const Checker checker(rays, box, camera, tolerance);
  checker.look_at_lattice(silhouette, fit, areas);
  if (silhouette.lines) checker.look_at_lines(silhouette, fit, areas);
  if (areas.foreground > 0) fit.missed = areas.missed / areas.foreground;
  if (areas.covered > 0) fit.excess = areas.excess / areas.covered;
  return fit;
}

}  // namespace

bool covers_line(const RayScene& rays, const Camera& camera, const LinePoint& point,
                 double tolerance) {
  const glm::dvec3 origin = camera.center();
  const glm::dvec2 middle(point.x, point.y);
  for (const glm::dvec2& direction :
       {glm::dvec2(point.normal_x, point.normal_y), glm::dvec2(-point.normal_y, point.normal_x)})
    for (double off = 0; off <= tolerance; off += kLineStep)
      if (rays.occluded(origin, camera.ray(middle + off * direction)) ||
          rays.occluded(origin, camera.ray(middle - off * direction)))
        return true;
  return false;
}

std::vector<SilhouetteFit> check_silhouettes(const RayScene& rays, const Box& box,
                                             std::span<const Camera> cameras,
                                             std::span<const CheckedSilhouette> silhouettes,
                                             double tolerance) {
  std::vector<SilhouetteFit> fits(cameras.size());
  tbb::parallel_for(std::size_t(0), cameras.size(), [&](std::size_t i) {
    if (silhouettes[i].given && silhouettes[i].used)
      fits[i] = check(rays, box, cameras[i], silhouettes[i], tolerance);
  });
  return fits;
}

}  // namespace photohull::assess
