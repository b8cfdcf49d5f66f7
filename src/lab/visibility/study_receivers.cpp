#include "lab/visibility/study_receivers.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "visibility/truth.h"

namespace photohull::visibility {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kMostRays = 600;    // along a side, that look for silhouettes
constexpr int kRaysPerPlace = 2;  // along a side, for each place on a silhouette that is wanted
constexpr int kDepthSteps = 48;   // depths at which a ray may leave what the eye sees
constexpr double kHalfLine = 4;   // texels
constexpr int kLineSamples = 65;

Camera at_size(Camera camera, int width, int height) {
  Intrinsics& in = camera.intrinsics;
  const double x = double(width) / in.width, y = double(height) / in.height;
  in.fx *= x, in.fy *= y;
  in.cx = (in.cx + 0.5) * x - 0.5, in.cy = (in.cy + 0.5) * y - 0.5;
  in.width = width, in.height = height;
  return camera;
}

dvec3 at_depth(const Camera& camera, const dvec2& pixel, double depth) {
  const dvec3 ray = camera.ray(pixel);
  return camera.center() + ray * (depth / glm::dot(ray, camera.forward()));
}

}  // namespace

Receivers receivers_of(const RayScene& rays, const TriMesh& mesh, const Camera& viewpoint,
                       const Camera& full_camera, int width, int height) {
  const Camera camera = at_size(full_camera, width, height);
  std::vector<Ray> primary;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) primary.push_back({camera.center(), camera.ray({x, y})});
  std::vector<Hit> hits(primary.size());
  rays.closest(primary, hits);
  Receivers out;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    const auto& t = mesh.triangles[hits[i].triangle];
    const dvec3 a = mesh.world(t[0]), b = mesh.world(t[1]), c = mesh.world(t[2]);
    Sample s;
    s.position = a + hits[i].u * (b - a) + hits[i].v * (c - a);
    s.normal = glm::normalize(glm::cross(b - a, c - a));
    if (glm::dot(s.normal, primary[i].direction) > 0) s.normal = -s.normal;
    if (glm::dot(s.normal, viewpoint.center() - s.position) <= 0) continue;
    const auto on_plane = [&](int x, int y) {
      const dvec3 ray = camera.ray({x, y});
      const double slant = glm::dot(ray, s.normal);
      if (std::abs(slant) < 1e-9) return dvec3(0.0);
      return camera.center() + ray * (glm::dot(s.position - camera.center(), s.normal) / slant) -
             s.position;
    };
    const int x = int(i) % width, y = int(i) / width;
    s.step_x = on_plane(x + 1, y), s.step_y = on_plane(x, y + 1);
    s.id = hits[i].triangle;
    out.samples.push_back(s);
    out.pixel.push_back(int(i));
  }
  out.truth = visible_by_rays(rays, viewpoint, out.samples);
  return out;
}

VisibilityErrors errors_of(const std::vector<float>& found,
                           const std::vector<std::uint8_t>& truth) {
  VisibilityErrors e;
  for (std::size_t i = 0; i < found.size(); ++i)
    (truth[i] ? e.false_occlusion : e.false_visibility) +=
        truth[i] ? 1 - double(found[i]) : double(found[i]);
  const double percent = 100.0 / double(std::max<std::size_t>(found.size(), 1));
  e.false_occlusion *= percent, e.false_visibility *= percent;
  return e;
}

Silhouettes::Silhouettes(const RayScene& rays, const Camera& viewpoint, const Box& bounds,
                         const Camera& eye, int count, unsigned seed)
    : rays_(rays), viewpoint_(viewpoint) {
  const int grid = std::min(kMostRays, kRaysPerPlace * count);
  const double step = double(viewpoint.intrinsics.width) / grid;
  const double middle = viewpoint.to_camera(bounds.center()).z, reach = 0.5 * bounds.diagonal();
  std::vector<double> depths(std::size_t(grid) * std::size_t(grid), 0.0);
  std::vector<Ray> lines;
  const dvec3 origin = viewpoint.center();
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const dvec2 pixel((double(i % grid) + 0.5) * step, (double(i / grid) + 0.5) * step);
    for (int k = kDepthSteps; k >= 0 && depths[i] == 0; --k) {
      const double depth = middle - reach + 2 * reach * k / kDepthSteps;
      const dvec3 p = at_depth(viewpoint, pixel, depth);
      const auto on_eye = eye.project(p);
      if (depth > 0 && bounds.contains(p) && on_eye && eye.on_image(*on_eye)) depths[i] = depth;
    }
    lines.push_back({origin, at_depth(viewpoint, pixel, std::max(depths[i], 1e-3)) - origin, 0, 1});
  }
  std::vector<std::uint8_t> blocked(lines.size());
  rays.occluded(lines, blocked);
  for (std::size_t i = 0; i + 1 < depths.size(); ++i) {
    if (int(i % grid) + 1 == grid || depths[i] == 0 || depths[i + 1] == 0) continue;
    if (blocked[i] == blocked[i + 1]) continue;
    places_.push_back({{(double(i % grid) + 0.5) * step, (double(i / grid) + 0.5) * step},
                       std::min(depths[i], depths[i + 1])});
  }
  std::mt19937_64 random(seed);
  for (std::size_t i = places_.size(); i > 1; --i) std::swap(places_[i - 1], places_[random() % i]);
  if (places_.size() > std::size_t(count)) places_.resize(std::size_t(count));
  for (Place& place : places_) {
    const auto hidden = [&](double x) {
      return rays_.occluded(origin, at_depth(viewpoint, {x, place.pixel.y}, place.depth) - origin,
                            0, 1);
    };
    double low = place.pixel.x, high = low + step;
    const bool left = hidden(low);
    for (int k = 0; k < 20; ++k) {
      const double x = 0.5 * (low + high);
      (hidden(x) == left ? low : high) = x;
    }
    // The line's middle lies anywhere within half a texel or so of the silhouette.
    place.pixel.x = low + (double(random() >> 11) * 0x1p-53 - 0.5) * 0.5;
  }
}

Sample Silhouettes::sample_at(const dvec2& pixel, double depth) const {
  Sample s;
  s.position = at_depth(viewpoint_, pixel, depth);
  s.normal = glm::normalize(viewpoint_.center() - s.position);
  const double width = depth / viewpoint_.intrinsics.fx;
  s.step_x = width * glm::transpose(viewpoint_.cam_from_world.rotation)[0];
  s.step_y = width * glm::transpose(viewpoint_.cam_from_world.rotation)[1];
  return s;
}

double Silhouettes::error(gpu::Context& context, const VisibilityMap& map, int resolution) const {
  const double pixels = double(viewpoint_.intrinsics.width) / resolution;
  std::vector<Sample> samples;
  for (const Place& place : places_)
    for (int k = 0; k < kLineSamples; ++k) {
      const double texels = kHalfLine * (2.0 * k / (kLineSamples - 1) - 1);
      samples.push_back(sample_at(place.pixel + dvec2(texels * pixels, 0), place.depth));
    }
  std::vector<Ray> lines;
  for (const Sample& s : samples)
    lines.push_back({viewpoint_.center(), s.position - viewpoint_.center(), 0, 1});
  std::vector<std::uint8_t> blocked(lines.size());
  rays_.occluded(lines, blocked);
  const std::vector<float> found = visible(context, map, samples);
  double sum = 0;
  int used = 0;
  for (std::size_t line = 0; line < places_.size(); ++line) {
    const std::size_t first = line * kLineSamples;
    int changes = 0;
    double wrong = 0;
    for (std::size_t k = first; k < first + kLineSamples; ++k) {
      changes += k > first && blocked[k] != blocked[k - 1];
      wrong += std::abs(found[k] - (blocked[k] ? 0.0 : 1.0));
    }
    if (changes != 1) continue;  // one silhouette a line
    ++used;
    sum += wrong * 2 * kHalfLine / (kLineSamples - 1);
  }
  return used ? sum / used : 0;
}

}  // namespace photohull::visibility
