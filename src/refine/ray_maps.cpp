// Depth along rays by comparing patches across them [Collins96].
#include "refine/ray_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "projtex/gpu_views.h"
#include "refine/match.h"
#include "shared/bake.h"
#include "shared/refine.h"

namespace photohull::refine {
namespace {

using gpu::Buffer;

constexpr int kLengths[] = {8, 16, 32, 64};  // samples along a ray
// Degrees between a view and those it is matched with, and what deviations cost.
constexpr double kNearestPartner = 4, kFarthestPartner = 60, kBestPartner = 15;
constexpr double kDuplicate = 8, kDuplicateCost = 30;
constexpr std::size_t kMostThreads = std::size_t(1) << 21;  // of a dispatch
// Samples about the surface that say whether it explains what a ray shows, voxels apart.
constexpr int kSurfaceSamples = 2;
constexpr double kBeside = 2;         // voxels from the surface within which a ray says nothing new
constexpr double kLeastStride = 1.5;  // pixels between rays: closer ones show the same

struct Ray {
  int view, x, y;
  glm::dvec3 from, direction;  // voxels; direction unit
  double length, depth_per_length;
  double surface = -1;  // where it meets the surface, voxels from `from`; negative: nowhere
};

double value_at(const SparseVolume& v, const glm::dvec3& p) {
  return v.at(glm::ivec3(glm::floor(p + 0.5)));
}

/// Where a ray enters the surface, about `t` voxels along it.
double crossing(const SparseVolume& surface, const glm::dvec3& from, const glm::dvec3& direction,
                double t) {
  double outside = t - 1.5, inside = t + 1;
  if (surface.interpolated(from + inside * direction) > 0) return t;
  for (int i = 0; i < 6; ++i) {
    const double middle = 0.5 * (outside + inside);
    (surface.interpolated(from + middle * direction) > 0 ? outside : inside) = middle;
  }
  return 0.5 * (outside + inside);
}

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

class RayMatcher {
 public:
  RayMatcher(gpu::Context& context, const SparseVolume& hull, const projtex::ImageSet& images,
             std::span<const Camera> cameras, double noise_sigma, const VoteOptions& options)
      : context_(context), hull_(hull), images_(images), options_(options), noise_(noise_sigma) {
    const glm::ivec2 size(images.texture().width(), images.texture().height());
    for (const Camera& camera : cameras) {
      cameras_.push_back(projtex::to_grid(camera, hull.grid));
      gpu_views_.push_back(projtex::to_gpu_view(cameras_.back(), size));
    }
  }

  std::vector<RayMap> run() {
    choose_partners();
    search(make_rays(nullptr));
    return std::move(maps_);
  }

  /// Only rays that the surface does not explain search the hull; what they find elsewhere than at
  /// the surface is news.
  std::vector<RayMap> run(const SparseVolume& surface) {
    choose_partners();
    std::vector<Ray> rays = make_rays(&surface);
    std::erase_if(rays, [](const Ray& ray) { return ray.surface < 0; });
    std::vector<Ray> unexplained;
    match(about_surface(rays), kSurfaceSamples, [&](std::size_t i, const float* s) {
      const int best = int(std::max_element(s, s + kSurfaceSamples) - s);
      if (s[best] < options_.least_score) {
        unexplained.push_back(rays[i]);
      } else {
        tell(rays[i], rays[i].surface, confidence(s[best]));
      }
    });
    tbb::parallel_for(std::size_t(0), unexplained.size(),
                      [&](std::size_t i) { reach_through_hull(unexplained[i]); });
    search(unexplained);
    return std::move(maps_);
  }

 private:
  void choose_partners() {
    const glm::dvec3 centre = 0.5 * glm::dvec3(hull_.grid.voxels());
    std::vector<glm::dvec3> d;
    for (const auto& c : cameras_) d.push_back(glm::normalize(c.centre - centre));
    for (std::size_t i = 0; i < d.size(); ++i) {
      std::vector<int> chosen{int(i)};
      while (chosen.size() < shaders::kMatchViews) {
        int best = -1;
        double least = 1e9;
        for (std::size_t j = 0; j < d.size(); ++j) {
          if (std::find(chosen.begin(), chosen.end(), int(j)) != chosen.end()) continue;
          const double angle = degrees_between(d[i], d[j]);
          if (angle < kNearestPartner || angle > kFarthestPartner) continue;
          double nearest = 180;
          for (const int k : chosen)
            nearest = std::min(nearest, degrees_between(d[std::size_t(k)], d[j]));
          const double cost =
              std::abs(angle - kBestPartner) + (nearest < kDuplicate ? kDuplicateCost : 0);
          if (cost < least) least = cost, best = int(j);
        }
        if (best < 0) break;
        chosen.push_back(best);
      }
      shaders::MatchChoice c{{-1, -1, -1, -1}, {-1, -1, 0, int(chosen.size())}, glm::ivec4(-1)};
      for (std::size_t k = 0; k < chosen.size(); ++k)
        (k < 4 ? c.first[int(k)] : c.second[int(k - 4)]) = chosen[k];
      partners_.push_back(c);
    }
  }

  /// Calls visit(t) for places in the hull along a ray, from `t` voxels on, until it returns false.
  template <typename Visit>
  void walk(const glm::dvec3& from, const glm::dvec3& d, double t, Visit&& visit) const {
    const glm::dvec3 high(hull_.grid.voxels() - 1);
    double end = 1e9;
    for (int a = 0; a < 3; ++a) {
      if (std::abs(d[a]) < 1e-12) continue;
      const double s = (0 - from[a]) / d[a], e = (high[a] - from[a]) / d[a];
      t = std::max(t, std::min(s, e));
      end = std::min(end, std::max(s, e));
    }
    while (t < end) {
      const double value = value_at(hull_, from + t * d);
      if (value <= 0.3 && !visit(t)) return;
      t += std::max(0.5, std::abs(value) * 0.8);
    }
  }

  /// A ray that ended where it met the surface goes on to where it leaves the hull.
  void reach_through_hull(Ray& ray) const {
    double last = ray.length - 1;
    walk(ray.from, ray.direction, last, [&](double t) {
      last = t;
      return true;
    });
    ray.length = last + 1;
  }

  /// Rays through the hull, and with a surface only as far as that.
  std::vector<Ray> make_rays(const SparseVolume* surface) {
    maps_.resize(cameras_.size());
    std::vector<std::vector<Ray>> found(cameras_.size());
    tbb::parallel_for(std::size_t(0), cameras_.size(), [&](std::size_t v) {
      const auto& c = cameras_[v];
      RayMap& map = maps_[v];
      const glm::dvec3 centre = 0.5 * glm::dvec3(hull_.grid.voxels());
      const double depth = (c.projection * glm::dvec4(centre, 1)).z;
      map.stride = std::max(kLeastStride, options_.ray_spacing * c.focal / std::max(depth, 1.0));
      map.width = int(std::ceil(c.width / map.stride));
      map.height = int(std::ceil(c.height / map.stride));
      map.depth.assign(std::size_t(map.width) * map.height, 0);
      map.weight = map.depth;
      const glm::dmat3 m(c.projection[0], c.projection[1], c.projection[2]);
      const glm::dmat3 inverse = glm::inverse(m);
      for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
          const glm::dvec3 d = glm::normalize(
              inverse * glm::dvec3((x + 0.5) * map.stride - 0.5, (y + 0.5) * map.stride - 0.5, 1));
          double first = -1, last = -1, at = -1;
          walk(c.centre, d, 0, [&](double t) {
            if (first < 0) first = t;
            last = t;
            if (!surface || value_at(*surface, c.centre + t * d) > 0) return true;
            at = crossing(*surface, c.centre, d, t);
            return false;
          });
          if (first < 0) continue;
          first -= 1;
          last += 1;
          found[v].push_back({int(v), x, y, c.centre + first * d, d, last - first, (m * d).z,
                              at < 0 ? -1 : at - first});
        }
    });
    std::vector<Ray> rays;
    for (const auto& list : found) rays.insert(rays.end(), list.begin(), list.end());
    return rays;
  }

  /// Rays that start before where the surface is and end behind.
  static std::vector<Ray> about_surface(std::vector<Ray> rays) {
    for (Ray& ray : rays) {
      ray.from += (ray.surface - 0.5 * (kSurfaceSamples - 1)) * ray.direction;
      ray.length = kSurfaceSamples;
    }
    return rays;
  }

  void search(const std::vector<Ray>& rays) {
    std::vector<Ray> by_length[std::size(kLengths)];
    for (const Ray& ray : rays) {
      std::size_t k = 0;
      while (k + 1 < std::size(kLengths) && ray.length > kLengths[k]) ++k;
      by_length[k].push_back(ray);
    }
    for (std::size_t k = 0; k < std::size(kLengths); ++k)
      match(by_length[k], kLengths[k],
            [&](std::size_t i, const float* s) { decide(by_length[k][i], s, kLengths[k]); });
  }

  /// Calls decide(i, scores) with the scores of `length` samples along the i-th ray.
  template <typename Decide>
  void match(const std::vector<Ray>& rays, int length, Decide&& decide) {
    const auto program =
        gpu::Program::compute("refine_match_patches.comp.glsl", "#define PATCH_RADIUS 1\n");
    const Buffer views = Buffer::of(gpu_views_);
    const std::size_t batch = kMostThreads / std::size_t(length);
    for (std::size_t first = 0; first < rays.size(); first += batch) {
      const std::size_t count = std::min(batch, rays.size() - first);
      std::vector<shaders::BakeVertex> surfels;
      std::vector<shaders::MatchChoice> choices;
      for (std::size_t i = first; i < first + count; ++i) {
        const Ray& ray = rays[i];
        surfels.push_back({glm::vec4(ray.from, std::max(1.0, ray.length / length)),
                           glm::vec4(-ray.direction, 0)});
        choices.push_back(partners_[std::size_t(ray.view)]);
      }
      shaders::MatchParameters p{};
      p.counts = {int(count), int(cameras_.size()), length, 0};
      p.search = {0, -1, float(options_.tap_spacing), 1};
      p.consistency = {float(noise_ * noise_), float(options_.best_pairs),
                       float(variance_floor(noise_)), 0};
      const Buffer uniforms(sizeof p, &p), surfel_buffer = Buffer::of(surfels),
                                           choice_buffer = Buffer::of(choices);
      const Buffer scores(count * std::size_t(length) * 4);
      uniforms.bind_uniform(0);
      views.bind_storage(0);
      surfel_buffer.bind_storage(1);
      choice_buffer.bind_storage(2);
      scores.bind_storage(3);
      const Buffer textures(count * sizeof(float));
      textures.bind_storage(5);
      images_.texture().bind(0);
      program.dispatch(context_, "refine_vote", gpu::group_count(count * std::size_t(length), 64));
      const auto s = scores.download<float>(count * std::size_t(length));
      for (std::size_t i = 0; i < count; ++i) decide(first + i, s.data() + i * std::size_t(length));
    }
  }

  void decide(const Ray& ray, const float* s, int length) {
    const double step = std::max(1.0, ray.length / length);
    const int n = std::min(length, int(std::ceil(ray.length / step)) + 1);
    int best = 0;
    for (int i = 1; i < n; ++i)
      if (s[i] > s[best]) best = i;
    if (s[best] < options_.least_score) return;
    float second = -1;
    for (int i = 0; i < n; ++i)
      if (std::abs(i - best) > 2) second = std::max(second, s[i]);
    double shift = 0;
    if (best > 0 && best + 1 < n) {
      const double curvature = s[best - 1] - 2.0 * s[best] + s[best + 1];
      if (curvature < 0)
        shift = std::clamp(0.5 * (s[best - 1] - s[best + 1]) / curvature, -0.5, 0.5);
    }
    tell(ray, (best + shift) * step,
         confidence(s[best]) * std::clamp((s[best] - second) / options_.distinct_by, 0.0, 1.0));
  }

  double confidence(double score) const {
    return std::clamp((score - options_.least_score) / 0.3, 0.0, 1.0);
  }

  /// The ray's say: what it shows lies `along` voxels from its start.
  void tell(const Ray& ray, double along, double weight) {
    RayMap& map = maps_[std::size_t(ray.view)];
    const std::size_t at = std::size_t(ray.y) * map.width + ray.x;
    const auto& c = cameras_[std::size_t(ray.view)];
    map.depth[at] =
        float(glm::dot(ray.from - c.centre, ray.direction) + along) * float(ray.depth_per_length);
    map.weight[at] = float(weight);
    if (ray.surface >= 0 && along < ray.surface - kBeside && weight > 0)
      map.before.push_back(glm::vec3(ray.from + along * ray.direction));
    if (ray.surface >= 0 && along > ray.surface + kBeside && weight > 0)
      for (double t = ray.surface; t < along - 1; t += 1)
        map.through.push_back(glm::vec3(ray.from + t * ray.direction));
  }

  gpu::Context& context_;
  const SparseVolume& hull_;
  const projtex::ImageSet& images_;
  const VoteOptions& options_;
  double noise_;
  std::vector<projtex::GridCamera> cameras_;
  std::vector<shaders::GpuView> gpu_views_;
  std::vector<shaders::MatchChoice> partners_;
  std::vector<RayMap> maps_;
};

}  // namespace

std::vector<RayMap> match_rays(gpu::Context& context, const SparseVolume& hull,
                               const projtex::ImageSet& images, std::span<const Camera> cameras,
                               double noise_sigma, const VoteOptions& options) {
  return RayMatcher(context, hull, images, cameras, noise_sigma, options).run();
}

std::vector<RayMap> match_rays_again(gpu::Context& context, const SparseVolume& hull,
                                     const SparseVolume& surface, const projtex::ImageSet& images,
                                     std::span<const Camera> cameras, double noise_sigma,
                                     const VoteOptions& options) {
  return RayMatcher(context, hull, images, cameras, noise_sigma, options).run(surface);
}

}  // namespace photohull::refine
