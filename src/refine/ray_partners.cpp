#include "refine/ray_partners.h"

#include <algorithm>
#include <cmath>

#include "core/viewing_depth.h"

namespace photohull::refine {
namespace {

// Degrees between a view and those it is matched with, and what deviations cost.
constexpr double kFarthestPartner = 60, kBestPartner = 15;
constexpr double kDuplicate = 8, kDuplicateCost = 30;

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

/// What a view within the box looks at.
glm::dvec3 looked_at(const projtex::GridCamera& camera, const Box& box) {
  const glm::dmat3 inverse =
      glm::inverse(glm::dmat3(camera.projection[0], camera.projection[1], camera.projection[2]));
  const double depth =
      viewing_depth(camera.projection, camera.centre, camera.width, camera.height, box);
  const glm::dvec2 middle = 0.5 * glm::dvec2(camera.width - 1, camera.height - 1);
  return camera.centre + depth * (inverse * glm::dvec3(middle, 1));
}

bool on_image(const projtex::GridCamera& camera, const glm::dvec3& point) {
  const glm::dvec3 p = camera.projection * glm::dvec4(point, 1);
  const double x = p.x / p.z, y = p.y / p.z;
  return p.z > 0 && x >= -0.5 && y >= -0.5 && x <= camera.width - 0.5 && y <= camera.height - 0.5;
}

/// The view among those not chosen yet whose angles suit best; -1: none. Views without a direction
/// do not suit.
int next_partner(std::span<const glm::dvec3> directions, std::span<const int> chosen,
                 double nearest_partner) {
  const glm::dvec3& own = directions[std::size_t(chosen.front())];
  int best = -1;
  double least = 1e9;
  for (std::size_t j = 0; j < directions.size(); ++j) {
    if (directions[j] == glm::dvec3(0)) continue;
    if (std::find(chosen.begin(), chosen.end(), int(j)) != chosen.end()) continue;
    const double angle = degrees_between(own, directions[j]);
    if (angle < nearest_partner || angle > kFarthestPartner) continue;
    double nearest = 180;
    for (const int k : chosen)
      nearest = std::min(nearest, degrees_between(directions[std::size_t(k)], directions[j]));
    const double cost =
        std::abs(angle - kBestPartner) + (nearest < kDuplicate ? kDuplicateCost : 0);
    if (cost < least) least = cost, best = int(j);
  }
  return best;
}

}  // namespace

std::vector<shaders::MatchChoice> choose_partners(std::span<const projtex::GridCamera> cameras,
                                                  const Box& box, double nearest) {
  std::vector<glm::dvec3> about_middle;
  for (const auto& camera : cameras)
    about_middle.push_back(glm::normalize(camera.centre - box.center()));
  std::vector<shaders::MatchChoice> out;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::vector<glm::dvec3> directions = about_middle;
    if (box.contains(cameras[i].centre)) {
      const glm::dvec3 target = looked_at(cameras[i], box);
      for (std::size_t j = 0; j < cameras.size(); ++j)
        directions[j] = i == j || on_image(cameras[j], target)
                            ? glm::normalize(cameras[j].centre - target)
                            : glm::dvec3(0);
    }
    std::vector<int> chosen{int(i)};
    while (chosen.size() < shaders::kMatchViews) {
      const int next = next_partner(directions, chosen, nearest);
      if (next < 0) break;
      chosen.push_back(next);
    }
    shaders::MatchChoice c{{-1, -1, -1, -1}, {-1, -1, 0, int(chosen.size())}, glm::ivec4(-1)};
    for (std::size_t k = 0; k < chosen.size(); ++k)
      (k < 4 ? c.first[int(k)] : c.second[int(k - 4)]) = chosen[k];
    out.push_back(c);
  }
  return out;
}

}  // namespace photohull::refine
