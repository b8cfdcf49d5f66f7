#include "cameras/frontier.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "masks/mask_lines.h"
#include "masks/photographed_mask.h"

namespace photohull {
namespace {

constexpr double kLevel = 127.5;  // coverage along the contour
constexpr double kFrame = 2;      // pixels

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Andrew's monotone chain, 1979.
std::vector<glm::dvec2> convex_hull(std::vector<glm::dvec2> points) {
  std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  std::vector<glm::dvec2> hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= first + 2 &&
             cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  if (points.size() < 3) return {};
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

/// The epipole in image a of camera b, homogeneous, in front of it or not.
glm::dvec3 epipole(const Camera& a, const Camera& b) {
  return a.intrinsics.k() * a.to_camera(b.center());
}

/// The two corners whose lines through the epipole have the outline on one side: on the positive
/// side of epipole x corner first. Nothing when the epipole is inside.
std::optional<std::array<glm::dvec2, 2>> tangents(const Outline& outline, const glm::dvec3& e) {
  std::array<std::optional<glm::dvec2>, 2> found;
  const std::size_t n = outline.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec2 &p = outline.corners[i], &before = outline.corners[(i + n - 1) % n],
                     &after = outline.corners[(i + 1) % n];
    const glm::dvec3 line = glm::cross(e, glm::dvec3(p, 1));
    const double s = glm::dot(line, glm::dvec3(before, 1));
    const double t = glm::dot(line, glm::dvec3(after, 1));
    if (s > 0 && t >= 0) found[0] = p;
    if (s < 0 && t <= 0) found[1] = p;
  }
  if (!found[0] || !found[1]) return std::nullopt;
  return std::array{*found[0], *found[1]};
}

bool near_frame(const Outline& outline, const glm::dvec2& p) {
  return p.x < kFrame || p.y < kFrame || p.x > outline.width - 1 - kFrame ||
         p.y > outline.height - 1 - kFrame;
}

/// Distance of a pixel of camera b from the line of what pixel p of camera a shows.
double distance_from_line(const Camera& a, const glm::dvec2& p, const Camera& b,
                          const glm::dvec2& q) {
  const glm::dvec3 ray = b.cam_from_world.rotation * a.ray(p);
  const glm::dvec3 line =
      glm::transpose(glm::inverse(b.intrinsics.k())) * glm::cross(b.to_camera(a.center()), ray);
  return glm::dot(line, glm::dvec3(q, 1)) / std::max(glm::length(glm::dvec2(line)), 1e-300);
}

/// Eight where the contour passes neither between that many pixels from here on, nor below them,
/// nor to the right of them; else 0. Pixels of the frame do not count.
int run_without_contour(const Mask& mask, int x, int y) {
  constexpr std::uint64_t kTopBits = 0x8080808080808080u;  // coverage of 128 and more
  if (x == 0 || y == 0 || x + 9 > mask.width || y + 1 >= mask.height) return 0;
  const std::uint8_t* here = &mask.coverage[std::size_t(y) * std::size_t(mask.width) + x];
  std::uint64_t eight[3];
  std::memcpy(&eight[0], here, 8);
  std::memcpy(&eight[1], here + 1, 8);
  std::memcpy(&eight[2], here + mask.width, 8);
  const bool none = ((eight[0] | eight[1] | eight[2]) & kTopBits) == 0;
  return none || (eight[0] & eight[1] & eight[2] & kTopBits) == kTopBits ? 8 : 0;
}

}  // namespace

Outline outline_of(const Mask& mask) { return outline_of(mask, find_lines(mask)); }

Outline outline_of(const Mask& mask, std::span<const LinePoint> lines) {
  std::vector<glm::dvec2> points;
  const auto at = [&](int x, int y) {
    return double(mask.coverage[std::size_t(y) * mask.width + x]);
  };
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (const int run = run_without_contour(mask, x, y); run > 0) {
        x += run - 1;
        continue;
      }
      const double here = at(x, y);
      const bool inside = here > kLevel;
      if (inside && (x == 0 || y == 0 || x == mask.width - 1 || y == mask.height - 1))
        points.emplace_back(x, y);
      for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
        if (x + dx >= mask.width || y + dy >= mask.height) continue;
        const double there = at(x + dx, y + dy);
        if (inside == (there > kLevel)) continue;
        const double share = (kLevel - here) / (there - here);
        points.emplace_back(x + share * dx, y + share * dy);
      }
    }
  // Half the coverage leaves out lines: their edges follow from their widths.
  for (const LinePoint& line : lines) {
    const glm::dvec2 middle(line.x, line.y), normal(line.normal_x, line.normal_y);
    points.push_back(middle + 0.5 * double(line.width) * normal);
    points.push_back(middle - 0.5 * double(line.width) * normal);
  }
  return {convex_hull(std::move(points)), mask.width, mask.height};
}

std::vector<Outline> outlines_of(std::span<const PreparedView> views) {
  std::vector<Outline> outlines(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!views[i].mask.empty())
      outlines[i] = outline_of(photographed_mask(views[i].image, views[i].mask));
  });
  return outlines;
}

std::vector<FrontierPair> frontier_pairs(std::span<const Camera> cameras,
                                         std::span<const Outline> outlines) {
  std::vector<FrontierPair> pairs;
  for (int a = 0; a < int(cameras.size()); ++a)
    for (int b = a + 1; b < int(cameras.size()); ++b) {
      if (outlines[a].corners.size() < 3 || outlines[b].corners.size() < 3) continue;
      const auto in_a = tangents(outlines[a], epipole(cameras[a], cameras[b]));
      const auto in_b = tangents(outlines[b], epipole(cameras[b], cameras[a]));
      if (!in_a || !in_b) continue;
      for (const glm::dvec2& p : *in_a) {
        // The same plane's tangent is the nearer one of the two in the other image.
        const double first = std::abs(distance_from_line(cameras[a], p, cameras[b], (*in_b)[0]));
        const double second = std::abs(distance_from_line(cameras[a], p, cameras[b], (*in_b)[1]));
        const glm::dvec2& q = (*in_b)[first <= second ? 0 : 1];
        if (!near_frame(outlines[a], p) && !near_frame(outlines[b], q))
          pairs.push_back({a, b, p, q});
      }
    }
  return pairs;
}

glm::dvec2 epipolar_distances(const Camera& a, const Camera& b, const FrontierPair& pair) {
  return {distance_from_line(b, pair.pixel_b, a, pair.pixel_a),
          distance_from_line(a, pair.pixel_a, b, pair.pixel_b)};
}

}  // namespace photohull
