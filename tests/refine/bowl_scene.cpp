#include "bowl_scene.h"

#include <algorithm>
#include <cmath>

#include "masks/silhouette.h"
#include "support/gl_context.h"
#include "volume/extract_mesh.h"

namespace photohull::test {
namespace {

using glm::dvec3;

constexpr double kFar = 10;  // along a ray
constexpr int kPhotoEdge = 112;

/// Length of a ray to the bowl; kFar where it misses.
double sight(const dvec3& eye, const dvec3& ray) {
  const double along = -glm::dot(eye, ray);
  if (glm::length(eye + along * ray) > 0.8) return kFar;
  double t = along - 0.85;
  while (t < along + 0.85) {
    const double d = bowl(eye + t * ray);
    if (d < 1e-4) return t;
    t += d;
  }
  return kFar;
}

dvec3 colour(const dvec3& eye, const dvec3& ray) {
  const double t = sight(eye, ray);
  return t < kFar ? 0.1 + 0.9 * noise_colour(eye + t * ray, 0.07) : dvec3(0.02, 0.02, 0.05);
}

PreparedView photograph(const Camera& camera) {
  PreparedView view;
  view.camera = camera;
  view.image = ray_cast(camera, colour, 2);
  view.mask = {kPhotoEdge, kPhotoEdge, {}};
  for (int y = 0; y < kPhotoEdge; ++y)
    for (int x = 0; x < kPhotoEdge; ++x) {
      int hits = 0;
      for (int i = 0; i < 9; ++i) {
        const glm::dvec2 pixel(x + (i % 3 - 1) / 3.0, y + (i / 3 - 1) / 3.0);
        hits += sight(camera.center(), camera.ray(pixel)) < kFar;
      }
      view.mask.coverage.push_back(std::uint8_t(std::lround(255 * hits / 9.0)));
    }
  return view;
}

BowlScene make_scene() {
  BowlScene scene;
  const auto add_ring = [&](int count, double elevation) {
    for (int i = 0; i < count; ++i) {
      const double turn = glm::radians(360.0 * i / count), e = glm::radians(elevation);
      const dvec3 direction(std::cos(e) * std::cos(turn), std::cos(e) * std::sin(turn),
                            std::sin(e));
      scene.views.push_back(
          photograph(look_at(4.0 * direction, dvec3(0), 230, kPhotoEdge, kPhotoEdge)));
    }
  };
  add_ring(12, 60);
  add_ring(16, 25);
  add_ring(8, -25);
  for (const PreparedView& view : scene.views) {
    scene.cameras.push_back(view.camera);
    scene.distances.push_back(silhouette_distance(view.mask));
  }
  return scene;
}

}  // namespace

double filled_bowl(const dvec3& p) { return std::max(glm::length(p) - 0.8, p.z - 0.2); }

double bowl(const dvec3& p) {
  return std::max(filled_bowl(p), 0.55 - glm::distance(p, dvec3(0, 0, 0.25)));
}

std::vector<carving::Silhouette> BowlScene::silhouettes(bool masks) const {
  std::vector<carving::Silhouette> out;
  static const Mask none;
  for (std::size_t i = 0; i < views.size(); ++i)
    out.push_back(masks ? carving::Silhouette{&views[i].mask, &distances[i]}
                        : carving::Silhouette{&none, nullptr});
  return out;
}

GridSpec BowlScene::grid(int edge) const {
  const double voxel = 2.0 / (edge * kBrickEdge);
  return {dvec3(-1 + 0.5 * voxel), voxel, glm::ivec3(edge)};
}

SparseVolume BowlScene::hull(const GridSpec& grid, bool masks) const {
  carving::HullOptions options;
  options.min_views = masks ? 1 : 2;
  Progress silent;
  return carving::carve_silhouette(gl_context(), {grid, box}, {cameras, silhouettes(masks)},
                                   options, silent);
}

const BowlScene& bowl_scene() {
  static const BowlScene scene = make_scene();
  return scene;
}

double mean_error(const SparseVolume& volume) {
  const TriMesh mesh = extract_mesh(volume);
  double sum = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    sum += std::abs(bowl(mesh.world(i))) / volume.grid.voxel_size;
  return sum / double(std::max<std::size_t>(mesh.positions.size(), 1));
}

}  // namespace photohull::test
