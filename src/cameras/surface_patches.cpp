// Based on: A. Gruen, "Adaptive least squares correlation", 1985 [Gruen85]; M. Goesele et al.,
// "Multi-view stereo for community photo collections", 2007 [Goesele07].
#include "cameras/surface_patches.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace photohull {
namespace {

/// Occupied voxels of a visual hull, x fastest.
class Hull {
 public:
  Hull(std::span<const Camera> cameras, std::span<const PreparedView> views, const Box& box,
       int cells) {
    const glm::dvec3 size = box.max - box.min;
    step_ = std::max({size.x, size.y, size.z}) / cells;
    for (int i = 0; i < 3; ++i) n_[i] = std::max(1, int(std::ceil(size[i] / step_)));
    origin_ = box.min + 0.5 * step_;
    filled_.resize(std::size_t(n_[0]) * n_[1] * n_[2]);
    tbb::parallel_for(0, n_[2], [&](int z) {
      for (int y = 0; y < n_[1]; ++y)
        for (int x = 0; x < n_[0]; ++x)
          filled_[index(x, y, z)] = is_filled(cameras, views, at(x, y, z));
    });
  }

  std::vector<SurfacePoint> surface() const {
    std::vector<SurfacePoint> points;
    for (int z = 0; z < n_[2]; ++z)
      for (int y = 0; y < n_[1]; ++y)
        for (int x = 0; x < n_[0]; ++x) {
          if (!filled(x, y, z)) continue;
          if (filled(x - 1, y, z) && filled(x + 1, y, z) && filled(x, y - 1, z) &&
              filled(x, y + 1, z) && filled(x, y, z - 1) && filled(x, y, z + 1))
            continue;
          const glm::dvec3 n = outwards(x, y, z);
          if (glm::length(n) > 0) points.push_back({at(x, y, z), glm::normalize(n)});
        }
    return points;
  }

 private:
  /// The outline at one half: lines do not count, for patches need surface several pixels wide.
  static bool is_filled(std::span<const Camera> cameras, std::span<const PreparedView> views,
                        const glm::dvec3& p) {
    constexpr int kEnough = 2;
    int background = 0, seen = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const Mask& mask = views[i].mask;
      if (mask.empty()) continue;
      const auto pixel = cameras[i].project(p);
      if (!pixel || !cameras[i].on_image(*pixel)) continue;
      const int u = std::clamp(int(std::lround(pixel->x)), 0, mask.width - 1);
      const int v = std::clamp(int(std::lround(pixel->y)), 0, mask.height - 1);
      ++seen;
      background += mask.coverage[std::size_t(v) * mask.width + u] < 128;
      if (background >= kEnough) return false;
    }
    return seen > 0;
  }

  bool filled(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < n_[0] && y < n_[1] && z < n_[2] &&
           filled_[index(x, y, z)];
  }

  /// From what is filled around to what is empty.
  glm::dvec3 outwards(int x, int y, int z) const {
    constexpr int kReach = 3;
    glm::dvec3 sum(0.0);
    for (int k = -kReach; k <= kReach; ++k)
      for (int j = -kReach; j <= kReach; ++j)
        for (int i = -kReach; i <= kReach; ++i)
          if (!filled(x + i, y + j, z + k)) sum += glm::dvec3(i, j, k);
    return sum;
  }

  std::size_t index(int x, int y, int z) const { return (std::size_t(z) * n_[1] + y) * n_[0] + x; }
  glm::dvec3 at(int x, int y, int z) const { return origin_ + step_ * glm::dvec3(x, y, z); }

  double step_ = 1;
  int n_[3] = {};
  glm::dvec3 origin_{0.0};
  std::vector<char> filled_;
};

/// Agreement of a patch with a place in another image, on every other pixel; -1 where it is not
/// held.
double correlation(const GreyImage& image, const glm::dvec2& source, const GreyImage& other,
                   const PatchPlace& place, int radius) {
  double n = 0, s = 0, t = 0, ss = 0, tt = 0, st = 0;
  for (int y = -radius; y <= radius; y += 2)
    for (int x = -radius; x <= radius; x += 2) {
      const glm::dvec2 from = source + glm::dvec2(x, y);
      const glm::dvec2 to = place.center + place.shape * glm::dvec2(x, y);
      if (!image.holds(from.x, from.y) || !other.holds(to.x, to.y)) return -1;
      const double a = image.at(from.x, from.y), b = other.at(to.x, to.y);
      n += 1, s += a, t += b, ss += a * a, tt += b * b, st += a * b;
    }
  const double variance = (n * ss - s * s) * (n * tt - t * t);
  return variance > 0 ? (n * st - s * t) / std::sqrt(variance) : -1;
}

class PatchMatcher {
 public:
  PatchMatcher(std::span<const Camera> cameras, std::span<const GreyImage> images,
               const PatchOptions& options)
      : cameras_(cameras), images_(images), options_(options) {}

  Track match(const SurfacePoint& p) const {
    Track track;
    const std::vector<int> seeing = views_of(p);
    if (seeing.size() < 2) return track;
    const Camera& main = cameras_[seeing[0]];
    const glm::dvec2 pixel = *main.project(p.position);
    const auto point = search(p, seeing, pixel);
    if (!point) return track;
    constexpr double kFarthest = 4;  // pixels from where the search has it
    track.observations.push_back({seeing[0], pixel});
    for (std::size_t i = 1; i < seeing.size(); ++i) {
      const auto place = place_on_plane(main, pixel, cameras_[seeing[i]], *point, p.normal);
      if (!place || !(glm::determinant(place->shape) > 0.1)) continue;
      const auto found = align_patch(images_[seeing[0]], pixel, images_[seeing[i]], *place,
                                     options_.radius, kFarthest, options_.least_gradient);
      if (found && found->agreement >= options_.least_agreement)
        track.observations.push_back({seeing[i], found->place.center});
    }
    std::sort(track.observations.begin(), track.observations.end(),
              [](const Observation& a, const Observation& b) { return a.view < b.view; });
    return track;
  }

 private:
  /// The view that faces the point, and those around it.
  std::vector<int> views_of(const SurfacePoint& p) const {
    constexpr double kFacing = 0.35;  // cosine
    const auto towards = [&](int v) { return glm::normalize(cameras_[v].center() - p.position); };
    int best = -1;
    double most = kFacing;
    for (int v = 0; v < int(cameras_.size()); ++v)
      if (const double c = glm::dot(towards(v), p.normal); c > most && holds(v, p.position))
        most = c, best = v;
    if (best < 0) return {};
    const double least = std::cos(options_.largest_angle * std::numbers::pi / 180);
    std::vector<std::pair<double, int>> others;
    for (int v = 0; v < int(cameras_.size()); ++v) {
      if (v == best || !(glm::dot(towards(v), p.normal) > kFacing) || !holds(v, p.position))
        continue;
      if (const double c = glm::dot(towards(v), towards(best)); c > least)
        others.emplace_back(-c, v);
    }
    std::sort(others.begin(), others.end());
    others.resize(std::min(others.size(), std::size_t(options_.views)));
    std::vector<int> found = {best};
    for (const auto& [order, v] : others) found.push_back(v);
    return found;
  }

  bool holds(int view, const glm::dvec3& p) const {
    const auto pixel = cameras_[view].project(p);
    return pixel && images_[view].holds(pixel->x - options_.radius, pixel->y - options_.radius) &&
           images_[view].holds(pixel->x + options_.radius, pixel->y + options_.radius);
  }

  /// The place along the ray where the patch agrees best with its neighbours.
  std::optional<glm::dvec3> search(const SurfacePoint& p, const std::vector<int>& seeing,
                                   const glm::dvec2& pixel) const {
    const Camera& main = cameras_[seeing[0]];
    const glm::dvec3 ray = main.ray(pixel);
    // A step moves the picture by a pixel where it moves most.
    const double probe = 1e-3 * glm::distance(main.center(), p.position);
    double speed = 0;
    for (const int v : seeing) {
      const auto a = cameras_[v].project(p.position),
                 b = cameras_[v].project(p.position + probe * ray);
      if (a && b) speed = std::max(speed, glm::distance(*a, *b) / probe);
    }
    if (!(speed > 0)) return std::nullopt;
    const int steps = int(options_.search);
    std::optional<glm::dvec3> best;
    double most = 0.6;
    for (int i = -steps; i <= steps; ++i) {
      const glm::dvec3 point = p.position + (i / speed) * ray;
      double sum = 0;
      for (std::size_t k = 1; k < seeing.size(); ++k) {
        const auto place = place_on_plane(main, pixel, cameras_[seeing[k]], point, p.normal);
        if (place)
          sum += std::max(0.0, correlation(images_[seeing[0]], pixel, images_[seeing[k]], *place,
                                           options_.radius));
      }
      const double mean = sum / double(seeing.size() - 1);
      if (mean > most) most = mean, best = point;
    }
    return best;
  }

  std::span<const Camera> cameras_;
  std::span<const GreyImage> images_;
  PatchOptions options_;
};

}  // namespace

std::optional<PatchPlace> place_on_plane(const Camera& a, const glm::dvec2& pixel, const Camera& b,
                                         const glm::dvec3& point, const glm::dvec3& normal) {
  const auto seen = [&](const glm::dvec2& p) -> std::optional<glm::dvec2> {
    const glm::dvec3 ray = a.ray(p);
    const double depth = glm::dot(point - a.center(), normal) / glm::dot(ray, normal);
    return b.project(a.center() + depth * ray);
  };
  const auto middle = seen(pixel), x = seen(pixel + glm::dvec2(1, 0)),
             y = seen(pixel + glm::dvec2(0, 1));
  if (!middle || !x || !y) return std::nullopt;
  return PatchPlace{*middle, glm::dmat2(*x - *middle, *y - *middle)};
}

std::vector<SurfacePoint> hull_points(std::span<const Camera> cameras,
                                      std::span<const PreparedView> views, const Box& box,
                                      int cells, int count) {
  const bool masks = std::any_of(views.begin(), views.end(),
                                 [](const PreparedView& v) { return !v.mask.empty(); });
  if (!masks) return {};
  const std::vector<SurfacePoint> all = Hull(cameras, views, box, cells).surface();
  std::vector<SurfacePoint> chosen;
  const double step = std::max(1.0, double(all.size()) / count);
  for (double i = 0; i < double(all.size()); i += step) chosen.push_back(all[std::size_t(i)]);
  return chosen;
}

std::vector<Track> patch_tracks(std::span<const Camera> cameras, std::span<const GreyImage> images,
                                std::span<const SurfacePoint> points, const PatchOptions& options,
                                Progress& progress) {
  const PatchMatcher matcher(cameras, images, options);
  std::vector<Track> tracks(points.size());
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
    if (!progress.cancelled()) tracks[i] = matcher.match(points[i]);
  });
  progress.check_cancelled();
  std::erase_if(tracks, [](const Track& t) { return t.observations.size() < 2; });
  return tracks;
}

}  // namespace photohull
