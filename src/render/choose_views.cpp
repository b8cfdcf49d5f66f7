#include "render/choose_views.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace photohull::render {
namespace {

constexpr std::size_t kSampledVertices = 4000;
constexpr int kCells = 32;                // along each side of an image
constexpr double kCosLeastAngle = 0.966;  // 15 degrees
constexpr double kLeastNear = 1e-3;       // of the far depth: what a depth buffer still tells apart

std::size_t stride_of(const TriMesh& mesh) {
  return std::max<std::size_t>(1, mesh.positions.size() / kSampledVertices);
}

struct Sphere {
  glm::dvec3 centre;
  double radius;
};

/// Around the bounding box.
Sphere bounds_of(const TriMesh& mesh) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return {mesh.origin + 0.5 * (glm::dvec3(low) + glm::dvec3(high)),
          0.5 * glm::distance(glm::dvec3(low), glm::dvec3(high))};
}

/// Cells of a coarse raster over the image that the mesh covers, times the share of the mesh that
/// lies on the image, squared.
double share_covered(const TriMesh& mesh, const Camera& camera) {
  std::vector<bool> covered(std::size_t(kCells) * kCells);
  std::size_t on_image = 0, sampled = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); i += stride_of(mesh), ++sampled) {
    const auto pixel = camera.project(mesh.world(i));
    if (!pixel || !camera.on_image(*pixel)) continue;
    ++on_image;
    const auto cell = [](double at, int size) {
      return std::min(int((at + 0.5) / size * kCells), kCells - 1);
    };
    covered[std::size_t(cell(pixel->y, camera.intrinsics.height)) * kCells +
            cell(pixel->x, camera.intrinsics.width)] = true;
  }
  const double share = double(on_image) / double(std::max<std::size_t>(sampled, 1));
  return double(std::count(covered.begin(), covered.end(), true)) * share * share;
}

}  // namespace

int choose_main_view(const TriMesh& mesh, std::span<const PreparedView> views) {
  int best = 0;
  double most = -1;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double seen = std::min(views[i].sharpness, 1.0) * share_covered(mesh, views[i].camera);
    if (!(seen > most)) continue;
    most = seen;
    best = int(i);
  }
  return best;
}

std::vector<int> choose_other_views(const TriMesh& mesh, std::span<const PreparedView> views,
                                    int main, int count) {
  const Sphere bounds = bounds_of(mesh);
  const auto direction = [&](int view) {
    return glm::normalize(views[view].camera.center() - bounds.centre);
  };
  std::vector<int> chosen{main};
  while (int(chosen.size()) <= count) {
    int best = -1;
    double least = kCosLeastAngle;  // cosine to the nearest chosen direction
    for (int i = 0; i < int(views.size()); ++i) {
      double nearest = -1;
      for (const int c : chosen) nearest = std::max(nearest, glm::dot(direction(i), direction(c)));
      if (nearest >= least) continue;
      if (views[i].camera.to_camera(bounds.centre).z <= bounds.radius) continue;
      least = nearest;
      best = i;
    }
    if (best < 0) break;
    chosen.push_back(best);
  }
  chosen.erase(chosen.begin());
  return chosen;
}

Window frame_mesh(const TriMesh& mesh, const Camera& camera, double margin) {
  const glm::dmat4x3 p = camera.projection();
  // Relative to the mesh's origin floats are exact enough, and quick.
  const glm::mat4x3 from_mesh(p[0], p[1], p[2], p * glm::dvec4(mesh.origin, 1));
  constexpr float kLargest = std::numeric_limits<float>::max();
  glm::vec3 low(kLargest), high(-kLargest);
  for (const glm::vec3& position : mesh.positions) {
    const glm::vec3 h = from_mesh * glm::vec4(position, 1);
    const glm::vec3 point(glm::vec2(h) / h.z, h.z);
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  if (!(low.z > kLeastNear * high.z)) {
    const Intrinsics& k = camera.intrinsics;
    return {-0.5, -0.5, double(k.width), double(k.height), kLeastNear * high.z, high.z};
  }
  const double grown = margin * std::max(high.x - low.x, high.y - low.y) + 1;
  return {low.x - grown, low.y - grown, high.x - low.x + 2 * grown, high.y - low.y + 2 * grown,
          low.z,         high.z};
}

}  // namespace photohull::render
