#include "refine/ray_partners.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/clip_ray.h"

namespace photohull::refine {
namespace {

// Degrees between a view and those it is matched with, and what deviations cost.
constexpr double kFarthestPartner = 60, kBestPartner = 15;
constexpr double kDuplicate = 8, kDuplicateCost = 30;

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

/// What the middle ray of a tile meets, if the scene fills the box: where it leaves the box that
/// the view stands in; else the part of it in the box that is as deep as the box's middle.
std::optional<glm::dvec3> looked_at(const projtex::GridCamera& camera, const Box& box,
                                    const glm::dvec2& pixel) {
  const glm::dmat3 inverse =
      glm::inverse(glm::dmat3(camera.projection[0], camera.projection[1], camera.projection[2]));
  const glm::dvec3 ray = inverse * glm::dvec3(pixel, 1);  // a step along it is one of depth
  const auto part = clip_ray(box, camera.centre, ray);
  if (!part) return std::nullopt;
  const double middle = (camera.projection * glm::dvec4(box.center(), 1)).z;
  return camera.centre + (box.contains(camera.centre)
                              ? part->second
                              : std::clamp(middle, part->first, part->second)) *
                             ray;
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

ViewChoice choose(std::span<const glm::dvec3> directions, int own, double nearest) {
  std::vector<int> chosen{own};
  while (chosen.size() < ViewChoice::kMostViews) {
    const int next = next_partner(directions, chosen, nearest);
    if (next < 0) break;
    chosen.push_back(next);
  }
  ViewChoice out;
  out.views = ViewList<ViewChoice::kMostViews>(chosen);
  return out;
}

bool all_see(const ViewChoice& choice, std::span<const projtex::GridCamera> cameras,
             const glm::dvec3& place) {
  return std::all_of(choice.views.begin(), choice.views.end(),
                     [&](int view) { return on_image(cameras[std::size_t(view)], place); });
}

/// Unit, from a place to the cameras that have it on their image, and to `own`; else 0.
std::vector<glm::dvec3> directions_from(const glm::dvec3& place,
                                        std::span<const projtex::GridCamera> cameras,
                                        std::size_t own) {
  std::vector<glm::dvec3> out;
  for (std::size_t j = 0; j < cameras.size(); ++j)
    out.push_back(j == own || on_image(cameras[j], place)
                      ? glm::normalize(cameras[j].centre - place)
                      : glm::dvec3(0));
  return out;
}

}  // namespace

std::vector<ViewPartners> choose_partners(std::span<const projtex::GridCamera> cameras,
                                          const Box& box, double nearest, int tiles) {
  std::vector<glm::dvec3> about_middle;
  for (const auto& camera : cameras)
    about_middle.push_back(glm::normalize(camera.centre - box.center()));
  std::vector<ViewPartners> out(cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const projtex::GridCamera& camera = cameras[i];
    const ViewChoice usual = choose(about_middle, int(i), nearest);
    out[i].across = tiles;
    for (int tile = 0; tile < tiles * tiles; ++tile) {
      const glm::dvec2 pixel(camera.width * (tile % tiles + 0.5) / tiles - 0.5,
                             camera.height * (tile / tiles + 0.5) / tiles - 0.5);
      const auto place = tiles > 1 ? looked_at(camera, box, pixel) : std::nullopt;
      const bool suits =
          !place || (!box.contains(camera.centre) && all_see(usual, cameras, *place));
      out[i].tiles.push_back(suits ? usual
                                   : choose(directions_from(*place, cameras, i), int(i), nearest));
    }
  }
  return out;
}

}  // namespace photohull::refine
