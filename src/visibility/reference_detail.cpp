// Maps of triangles, in plain double precision.
#include <algorithm>
#include <cmath>
#include <limits>

#include "visibility/reference.h"

namespace photohull::visibility::reference {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kWidestGap = 1;      // texels
constexpr double kLargeTriangle = 4;  // texels

}  // namespace

double Map::exact(const Sample& s, const Place& place) const {
  const Sight line = sight(place.part, place.at);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (ids_[i] == s.id) continue;
    const Crossing c = cross(line, i);
    if (c.inside() && c.w >= layout_.parts[place.part].nearest_w &&
        depth_on(place.part, line, c.w) < place.z - bias_)
      return 0;
  }
  return 1;
}

double Map::depth_of(int part, std::uint32_t triangle, const dvec2& at) const {
  double low = kInfinity, high = 0;
  for (const dvec3& v : triangles_[triangle]) {
    const double z = glm::dot(layout_.parts[part].row_z, dvec4(v, 1));
    low = std::min(low, z), high = std::max(high, z);
  }
  const Sight line = sight(part, at);
  const Crossing c = cross(line, triangle);
  if (!c.exists || c.w <= 0) return high;
  return std::clamp(depth_on(part, line, c.w), std::max(low, 0.0), high);
}

std::uint32_t Map::nearest_in(int part, const ivec2& texel) const {
  double least = kInfinity;
  std::uint32_t nearest = shaders::kNoTriangle;
  for (const std::uint32_t i : triangles_in(part, texel)) {
    const double z = depth_of(part, i, dvec2(texel) + 0.5);
    if (z < least) least = z, nearest = i;
  }
  return nearest;
}

std::uint32_t Map::kept(int part, const ivec2& texel) const {
  if (texel != clamped(texel)) return shaders::kNoTriangle;
  if (nearest_.empty())
    for (int p = 0; p < int(layout_.parts.size()); ++p)
      for (int y = 0; y < layout_.size.y; ++y)
        for (int x = 0; x < layout_.size.x; ++x) nearest_.push_back(nearest_in(p, {x, y}));
  return nearest_[(std::size_t(part) * layout_.size.y + texel.y) * layout_.size.x + texel.x];
}

std::vector<std::uint32_t> Map::links_of(int part, const ivec2& texel) const {
  std::vector<std::uint32_t> out;
  if (kept(part, texel) != shaders::kNoTriangle) out.push_back(kept(part, texel));
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const std::uint32_t i = kept(part, texel + ivec2(x, y));
      if (i == shaders::kNoTriangle || std::count(out.begin(), out.end(), i)) continue;
      bool holds = false;
      for (const dvec2& corner : {dvec2(0, 0), dvec2(1, 0), dvec2(0, 1), dvec2(1, 1)})
        holds = holds || holds_place(part, i, dvec2(texel) + corner);
      if (holds && int(out.size()) < shaders::kMaxLinks) out.push_back(i);
    }
  return out;
}

bool Map::holds_place(int part, std::uint32_t triangle, const dvec2& at) const {
  const Crossing c = cross(sight(part, at), triangle);
  return c.inside() && c.w > 0;
}

double Map::slack_beside(const Sample& s, const Place& place) const {
  return 2 * change_within_texel(s, place) + layout_.texel_width * place.z;
}

double Map::least_height(int part, std::uint32_t triangle, const dvec2& at) const {
  double farthest = 0;
  for (const dvec3& v : triangles_[triangle])
    farthest = std::max(farthest, glm::dot(layout_.parts[part].row_w, dvec4(v, 1)));
  // Barycentric coordinates over w are linear on the map.
  const double step = 1e-2;
  const auto over_w = [&](const dvec2& p) {
    const Crossing c = cross(sight(part, p), triangle);
    return dvec3(c.b0, c.b1, c.b2) / c.w;
  };
  const dvec3 dx = (over_w(at + dvec2(step, 0)) - over_w(at)) / step;
  const dvec3 dy = (over_w(at + dvec2(0, step)) - over_w(at)) / step;
  double steepest = 0;
  for (int i = 0; i < 3; ++i) steepest = std::max(steepest, std::hypot(dx[i], dy[i]));
  return 1 / (farthest * steepest);
}

bool Map::surrounded(const Sample& s, const Place& place) const {
  const ivec2 first(glm::floor(place.at - 0.5));
  const double slack = slack_beside(s, place);
  const std::uint32_t own = kept(place.part, clamped(ivec2(glm::floor(place.at))));
  if (own == shaders::kNoTriangle || least_height(place.part, own, place.at) >= kLargeTriangle)
    return false;
  for (int y = 0; y <= 1; ++y)
    for (int x = 0; x <= 1; ++x) {
      const ivec2 texel = clamped(first + ivec2(x, y));
      const std::uint32_t i = kept(place.part, texel);
      if (i == shaders::kNoTriangle || i == s.id) return false;
      for (const dvec2& corner : {dvec2(0, 0), dvec2(1, 0), dvec2(0, 1), dvec2(1, 1)})
        if (depth_of(place.part, i, dvec2(texel) + corner) >= place.z - slack) return false;
    }
  return true;
}

bool Map::hides(const Sample& s, const Place& place, std::uint32_t triangle, const dvec2& at,
                double slack) const {
  return triangle != s.id && holds_place(place.part, triangle, at) &&
         depth_of(place.part, triangle, at) < place.z - slack;
}

double Map::sub_pixel(const Sample& s, const Place& place) const {
  const ivec2 centre = clamped(ivec2(glm::floor(place.at)));
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const std::uint32_t i = kept(place.part, clamped(centre + ivec2(x, y)));
      if (i != shaders::kNoTriangle && hides(s, place, i, place.at, bias_)) return 0;
    }
  return surrounded(s, place) ? 0 : 1;
}

bool Map::in_gap(const Sample& s, const Place& place) const {
  const ivec2 texel = clamped(ivec2(glm::floor(place.at)));
  const double slack = slack_beside(s, place);
  double least = kWidestGap;
  dvec2 outward(0.0);
  for (const std::uint32_t i : links_of(place.part, texel)) {
    if (i == s.id || depth_of(place.part, i, place.at) >= place.z - slack) continue;
    // Distances to the sides' lines, by the corners' projections (all lie before the viewpoint).
    dvec2 corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = locate(place.part, triangles_[i][k]).at;
    double beyond = -kInfinity;
    dvec2 normal(0.0);
    for (int k = 0; k < 3; ++k) {
      const dvec2 a = corner[k], b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
      dvec2 n = glm::normalize(dvec2(b.y - a.y, a.x - b.x));
      if (glm::dot(n, c - a) > 0) n = -n;
      if (glm::dot(n, place.at - a) > beyond) beyond = glm::dot(n, place.at - a), normal = n;
    }
    if (beyond < least) least = beyond, outward = normal;
  }
  if (least == kWidestGap) return false;
  for (const double step : {0.5 * kWidestGap, kWidestGap}) {
    const dvec2 at = place.at + step * outward;
    for (const std::uint32_t i : links_of(place.part, clamped(ivec2(glm::floor(at)))))
      if (hides(s, place, i, at, slack)) return true;
  }
  return false;
}

double Map::coverage(const Sample& s, const Place& place) const {
  for (const std::uint32_t i : links_of(place.part, clamped(ivec2(glm::floor(place.at)))))
    if (hides(s, place, i, place.at, bias_)) return 0;
  return in_gap(s, place) || surrounded(s, place) ? 0 : 1;
}

std::vector<dvec2> Map::clipped(int part, std::size_t triangle, const ivec2& texel) const {
  const PartLayout& l = layout_.parts[part];
  std::vector<dvec3> polygon;
  for (const dvec3& v : triangles_[triangle])
    polygon.emplace_back(glm::dot(l.row_x, dvec4(v, 1)), glm::dot(l.row_y, dvec4(v, 1)),
                         glm::dot(l.row_w, dvec4(v, 1)));
  // Half-spaces of homogeneous points: before the viewpoint, and within the texel's sides.
  const dvec4 planes[] = {{0, 0, 1, l.nearest_w},
                          {1, 0, -double(texel.x), 0},
                          {-1, 0, texel.x + 1.0, 0},
                          {0, 1, -double(texel.y), 0},
                          {0, -1, texel.y + 1.0, 0}};
  for (const dvec4& plane : planes) {
    std::vector<dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double da = glm::dot(dvec3(plane), a) - plane.w,
                   db = glm::dot(dvec3(plane), b) - plane.w;
      if (da >= 0) kept.push_back(a);
      if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    polygon = std::move(kept);
  }
  std::vector<dvec2> out;
  for (const dvec3& h : polygon) out.push_back(dvec2(h) / h.z);
  return out;
}

std::vector<std::uint32_t> Map::triangles_in(int part, const ivec2& texel) const {
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const std::vector<dvec2> polygon = clipped(part, i, texel);
    double area = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const dvec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      area += a.x * b.y - a.y * b.x;
    }
    if (std::abs(area) > 0) out.push_back(std::uint32_t(i));
  }
  return out;
}

std::vector<std::uint32_t> Map::seen_in(int part, const ivec2& texel) const {
  struct Inside {
    std::uint32_t triangle;
    double near, far;
    bool covers;
  };
  std::vector<Inside> all;
  double limit = kInfinity;
  for (const std::uint32_t i : triangles_in(part, texel)) {
    Inside in{i, kInfinity, 0, true};
    for (const dvec2& at : clipped(part, i, texel)) {
      const Sight line = sight(part, at);
      const double z = depth_on(part, line, cross(line, i).w);
      in.near = std::min(in.near, z), in.far = std::max(in.far, z);
    }
    for (const dvec2& corner : {dvec2(0, 0), dvec2(1, 0), dvec2(0, 1), dvec2(1, 1)})
      in.covers = in.covers && cross(sight(part, dvec2(texel) + corner), i).inside();
    if (in.covers) limit = std::min(limit, in.far);
    all.push_back(in);
  }
  std::vector<std::uint32_t> out;
  for (const Inside& in : all)
    if (in.near <= limit) out.push_back(in.triangle);
  return out;
}

}  // namespace photohull::visibility::reference
