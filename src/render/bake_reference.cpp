#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/bake_colour.h"
#include "shared/bake.h"
#include "visibility/kernels/depth_maps.h"

namespace photohull::render::reference {
namespace {

struct Sight {
  const BakeView* view = nullptr;
  double weight = 0;
  glm::dvec3 direction{0};  ///< unit, towards the camera
  glm::dvec3 colour{0};     ///< linear
  glm::dvec3 root{0};       ///< square roots of colour
  glm::dvec3 detail{0};     ///< root less that of the surroundings
};

/// Projects and tests for the image; depth is 0 when the point is not on it.
glm::dvec3 to_pixel(const projtex::GridCamera& camera, const glm::dvec3& point) {
  const glm::dvec3 h = camera.projection * glm::dvec4(point, 1);
  const glm::dvec2 pixel = glm::dvec2(h) / h.z;
  const bool on = h.z > 0 && pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= camera.width - 0.5 &&
                  pixel.y <= camera.height - 0.5;
  return {pixel, on ? h.z : 0.0};
}

std::vector<Sight> find_sights(std::span<const BakeView> views, const glm::dvec3& position,
                               const glm::dvec3& normal) {
  std::vector<Sight> sights;
  for (const BakeView& view : views) {
    const glm::dvec3 offset = view.camera.centre - position;
    const double distance = glm::length(offset);
    if (!(distance > 0)) continue;
    const double cosine = glm::dot(offset, normal) / distance;
    const glm::dvec3 receiver = position + double(shaders::kBakeShift) * normal;
    const glm::dvec3 p = to_pixel(view.camera, receiver);
    if (cosine <= shaders::kBakeMinCosine || p.z <= 1) continue;
    if (!visibility::reference::visible(view.camera, view.depth_info, receiver,
                                        shaders::kBakeDepthBias, view.depths))
      continue;
    const double weight =
        std::pow(cosine, 3) * std::pow(view.camera.focal / p.z, 2) * std::pow(view.sharpness, 8);
    sights.push_back({&view, weight, offset / distance});
  }
  return sights;
}

/// 0 for one direction, growing with every direction that differs from the mean.
double scatter_of(const std::vector<Sight>& sights) {
  glm::dvec3 mean(0);
  for (const Sight& s : sights) mean += s.direction / double(sights.size());
  double sum = 0;
  for (const Sight& s : sights) sum += glm::dot(s.direction - mean, s.direction - mean);
  return sum;
}

/// Keeps the heaviest that know a colour, and looks it up.
void keep_best(std::vector<Sight>& sights, const glm::dvec3& position) {
  std::stable_sort(sights.begin(), sights.end(),
                   [](const Sight& a, const Sight& b) { return a.weight > b.weight; });
  sights.resize(std::min<std::size_t>(sights.size(), shaders::kMaxBakeViews));
  std::erase_if(sights, [&](Sight& s) {
    const glm::dvec3 p = to_pixel(s.view->camera, position);
    if (p.z <= 0) return true;
    const int level = int(std::lround(std::max(0.0, std::log2(s.view->camera.focal / p.z))));
    const glm::dvec4 texel = sample(*s.view->image, glm::dvec2(p), level);
    s.colour = glm::max(glm::dvec3(texel), 0.0);
    s.root = glm::sqrt(s.colour);
    const glm::dvec4 around =
        sample(*s.view->image, glm::dvec2(p), level + shaders::kBakeDetailLevels);
    s.detail = s.root - glm::sqrt(glm::max(glm::dvec3(around), 0.0));
    return texel.a < shaders::kBakeMinAlpha;
  });
}

glm::dvec3 robust_mean(const std::vector<Sight>& sights, double noise_sigma) {
  const auto mean_distance = [&](const Sight& from) {
    double sum = 0, weight = 0;
    for (const Sight& s : sights) {
      sum += s.weight * glm::distance(s.root, from.root);
      weight += s.weight;
    }
    return sum / weight;
  };
  std::vector<double> costs;
  for (const Sight& s : sights) costs.push_back(mean_distance(s));
  const auto least = std::min_element(costs.begin(), costs.end());
  const glm::dvec3 medoid = sights[std::size_t(least - costs.begin())].root;
  const double scale = 2 * noise_sigma + *least;
  glm::dvec3 sum(0);
  double weight = 0;
  for (const Sight& s : sights) {
    const double ratio = glm::distance(s.root, medoid) / scale;
    const double w = s.weight * std::pow(1 + ratio * ratio, -2);
    sum += w * s.colour;
    weight += w;
  }
  return sum / weight;
}

}  // namespace

void splat_point(const glm::dvec3& position, const glm::dvec3& normal, BakeView& view) {
  const glm::dvec3 p = to_pixel(view.camera, position);
  if (p.z <= 1 || glm::dot(view.camera.centre - position, normal) < 0) return;
  const glm::ivec4& size = view.depth_info.size;
  const double scale = view.depth_info.scale.x;
  const glm::dvec2 middle = (glm::dvec2(p) + 0.5) * scale;
  const glm::ivec2 last = glm::ivec2(size) - 1;
  glm::ivec2 low = glm::min(glm::ivec2(middle), last), high = low;
  const double half = std::min(0.5 * view.camera.focal / p.z * scale, double(shaders::kSplatReach));
  if (half > 0.5) {
    low = glm::max(glm::ivec2(glm::floor(middle - half)), 0);
    high = glm::min(glm::ivec2(glm::floor(middle + half)), last);
  }
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      double& depth = view.depths[std::size_t(y) * size.x + x];
      depth = std::min(depth, p.z);
    }
}

BakedVertex bake_vertex(std::span<const BakeView> views, double noise_sigma,
                        const glm::dvec3& position, const glm::dvec3& normal) {
  std::vector<Sight> sights = find_sights(views, position, normal);
  if (sights.empty()) return {};
  const double scatter = scatter_of(sights);
  const std::size_t seeing = sights.size();
  keep_best(sights, position);
  if (sights.empty()) return {};
  BakedVertex out;
  out.colour = robust_mean(sights, noise_sigma);
  const auto mean = [&](auto value) {
    double sum = 0, weight = 0;
    for (const Sight& s : sights) {
      sum += s.weight * value(s);
      weight += s.weight;
    }
    return sum / weight;
  };
  glm::dvec3 detail;
  for (int c = 0; c < 3; ++c) detail[c] = mean([&](const Sight& s) { return s.detail[c]; });
  const auto squared = [](const glm::dvec3& v) { return glm::dot(v, v); };
  SurfaceEvidence& e = out.evidence;
  e.views = float(sights.size());
  e.scatter = float(scatter);
  e.seeing = float(seeing);
  e.disagreement =
      float(mean([&](const Sight& s) { return squared(s.root - glm::sqrt(out.colour)); }));
  e.fine_disagreement = float(mean([&](const Sight& s) { return squared(s.detail - detail); }));
  e.fine_energy = float(mean([&](const Sight& s) { return squared(s.detail); }));
  return out;
}

glm::dvec4 sample(const ColourImage& image, const glm::dvec2& pixel, int level) {
  const int edge = 1 << std::clamp(level, 0, 16);
  const int width = std::max(1, image.width / edge), height = std::max(1, image.height / edge);
  const auto texel = [&](int tx, int ty) {
    const int x0 = std::clamp(tx, 0, width - 1) * edge, y0 = std::clamp(ty, 0, height - 1) * edge;
    glm::dvec4 sum(0);
    double count = 0;
    for (int y = y0; y < std::min(y0 + edge, image.height); ++y)
      for (int x = x0; x < std::min(x0 + edge, image.width); ++x, ++count)
        sum += glm::dvec4(image.linear(x, y));
    return sum / count;
  };
  const glm::dvec2 at = (pixel + 0.5) / double(edge) - 0.5;
  const int x = int(std::floor(at.x)), y = int(std::floor(at.y));
  const double fx = at.x - x, fy = at.y - y;
  return (1 - fy) * ((1 - fx) * texel(x, y) + fx * texel(x + 1, y)) +
         fy * ((1 - fx) * texel(x, y + 1) + fx * texel(x + 1, y + 1));
}

}  // namespace photohull::render::reference
