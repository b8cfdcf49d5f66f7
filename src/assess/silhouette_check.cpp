#include "assess/silhouette_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/clip_ray.h"

namespace photohull::assess {
namespace {

constexpr double kRays = 4000;      // a view, about
constexpr double kLineStep = 0.15;  // pixels across a line: a tube may be a third of a pixel wide
constexpr double kWidestLine = 2;   // pixels, about

struct Areas {
  double foreground = 0, missed = 0, beyond_box = 0;  ///< pixels
  double missed_times_width = 0;                      ///< pixels, cubed
  double covered = 0, excess = 0;                     ///< places of a lattice

  void look_at(double area, double width, bool hit) {
    foreground += area;
    if (hit) return;
    missed += area;
    missed_times_width += area * width;
  }
};

/// The middles of the parts of the foreground that are narrower than `widest` pixels and no lines,
/// a pixel apart: where the distance to the outline has a ridge.
std::vector<LinePoint> narrow_parts(const SilhouetteDistance& d, double widest) {
  constexpr int kAcross[][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  std::vector<LinePoint> out;
  for (int y = 1; y + 1 < d.height; ++y)
    for (int x = 1; x + 1 < d.width; ++x) {
      const float* at = &d.pixels[std::size_t(y) * std::size_t(d.width) + std::size_t(x)];
      if (*at > -0.5 * kWidestLine || *at < -0.5 * widest) continue;
      for (const auto& [dx, dy] : kAcross) {
        const long step = long(dy) * d.width + dx;
        if (!(at[-step] > *at && at[step] >= *at)) continue;
        const float length = std::hypot(float(dx), float(dy));
        out.push_back({float(x), float(y), float(dx) / length, float(dy) / length, -2 * *at});
        break;
      }
    }
  return out;
}

class Checker {
 public:
  Checker(const RayScene& rays, const Box& box, const Camera& camera, double tolerance)
      : rays_(rays), box_(box), camera_(camera), origin_(camera.center()), tolerance_(tolerance) {}

  /// The lattice has as many places in a stem as in a body: a place of the whole picture's lattice
  /// would stand for a tenth of the foreground where that is small.
  void look_at_foreground(const CheckedSilhouette& s, SilhouetteFit& fit, Areas& areas) const {
    const SilhouetteDistance& given = *s.given;
    const auto inside = [&](float d) { return d < -tolerance_; };
    const int step = lattice_step(std::ranges::count_if(given.pixels, inside));
    visit_lattice(given, step, [&](int x, int y, std::size_t i) {
      if (!inside(given.pixels[i])) return;
      const glm::dvec3 ray = camera_.ray({x, y});
      const double area = sureness(s, i) * step * step;
      if (!clip_ray(box_, origin_, ray)) {
        areas.beyond_box += area;
        return;
      }
      ++fit.foreground;
      areas.look_at(area, -2 * double(given.pixels[i]), rays_.occluded(origin_, ray));
    });
  }

  void look_for_excess(const CheckedSilhouette& s, SilhouetteFit& fit, Areas& areas) const {
    const SilhouetteDistance &given = *s.given, &used = *s.used;
    visit_lattice(given, lattice_step(given.pixels.size()), [&](int x, int y, std::size_t i) {
      const bool outside = used.pixels[i] > tolerance_;
      if (!outside && !(given.pixels[i] < -tolerance_)) return;
      const glm::dvec3 ray = camera_.ray({x, y});
      if (!clip_ray(box_, origin_, ray) || !rays_.occluded(origin_, ray)) return;
      ++fit.covered;
      areas.covered += 1;
      areas.excess += outside;
    });
  }

  void look_at_lines(const CheckedSilhouette& s, const std::vector<LinePoint>& lines,
                     SilhouetteFit& fit, Areas& areas) const {
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
      areas.look_at(area, p.width, hit);
    }
  }

 private:
  /// Pixels between places of a lattice that has some thousand among so many pixels.
  static int lattice_step(std::size_t pixels) {
    return std::max(1, int(std::sqrt(double(pixels) / kRays)));
  }

  static void visit_lattice(const SilhouetteDistance& d, int step, auto&& visit) {
    for (int y = step / 2; y < d.height; y += step)
      for (int x = step / 2; x < d.width; x += step)
        visit(x, y, std::size_t(y) * std::size_t(d.width) + x);
  }

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
  checker.look_at_foreground(silhouette, fit, areas);
  checker.look_for_excess(silhouette, fit, areas);
  if (silhouette.lines) checker.look_at_lines(silhouette, *silhouette.lines, fit, areas);
  checker.look_at_lines(silhouette, narrow_parts(*silhouette.given, 2 * tolerance), fit, areas);
  if (areas.foreground > 0) {
    fit.missed = areas.missed / areas.foreground;
    fit.beyond_box = areas.beyond_box / (areas.beyond_box + areas.foreground);
  }
  if (areas.missed > 0) fit.missed_width = areas.missed_times_width / areas.missed;
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
