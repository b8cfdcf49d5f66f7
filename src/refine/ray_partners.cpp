#include "refine/ray_partners.h"

#include <algorithm>
#include <cmath>

namespace photohull::refine {
namespace {

// Degrees between a view and those it is matched with, and what deviations cost.
constexpr double kNearestPartner = 4, kFarthestPartner = 60, kBestPartner = 15;
constexpr double kDuplicate = 8, kDuplicateCost = 30;

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

/// The view among those not chosen yet whose angles suit best; -1: none.
int next_partner(std::span<const glm::dvec3> directions, std::span<const int> chosen) {
  const glm::dvec3& own = directions[std::size_t(chosen.front())];
  int best = -1;
  double least = 1e9;
  for (std::size_t j = 0; j < directions.size(); ++j) {
    if (std::find(chosen.begin(), chosen.end(), int(j)) != chosen.end()) continue;
    const double angle = degrees_between(own, directions[j]);
    if (angle < kNearestPartner || angle > kFarthestPartner) continue;
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
                                                  const glm::dvec3& middle) {
  std::vector<glm::dvec3> directions;
  for (const auto& camera : cameras) directions.push_back(glm::normalize(camera.centre - middle));
  std::vector<shaders::MatchChoice> out;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    std::vector<int> chosen{int(i)};
    while (chosen.size() < shaders::kMatchViews) {
      const int next = next_partner(directions, chosen);
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
