#include "visibility/convex.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace photohull::visibility {
namespace {

/// Points of a convex cut in the order around their centre.
void order_around(std::vector<glm::dvec3>& points, const glm::dvec3& normal) {
  glm::dvec3 centre(0.0);
  for (const glm::dvec3& p : points) centre += p / double(points.size());
  const glm::dvec3 side = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(normal, side)), v = glm::cross(normal, u);
  const auto angle = [&](const glm::dvec3& p) {
    return std::atan2(glm::dot(p - centre, v), glm::dot(p - centre, u));
  };
  std::sort(points.begin(), points.end(),
            [&](const glm::dvec3& a, const glm::dvec3& b) { return angle(a) < angle(b); });
}

}  // namespace

Convex::Convex(const Box& box) {
  const auto corner = [&](int i) {
    return glm::dvec3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                      i & 4 ? box.max.z : box.min.z);
  };
  for (const auto& f : {std::array{0, 2, 6, 4}, std::array{1, 5, 7, 3}, std::array{0, 4, 5, 1},
                        std::array{2, 3, 7, 6}, std::array{0, 1, 3, 2}, std::array{4, 6, 7, 5}})
    faces_.push_back({corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])});
}

void Convex::cut(const glm::dvec3& normal, double offset) {
  std::vector<std::vector<glm::dvec3>> kept;
  std::vector<glm::dvec3> lid;
  for (const auto& face : faces_) {
    std::vector<glm::dvec3> out;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const glm::dvec3 &a = face[i], &b = face[(i + 1) % face.size()];
      const double da = glm::dot(normal, a) - offset, db = glm::dot(normal, b) - offset;
      if (da >= 0) out.push_back(a);
      if ((da >= 0) != (db >= 0)) {
        out.push_back(a + (b - a) * (da / (da - db)));
        lid.push_back(out.back());
      }
    }
    if (out.size() >= 3) kept.push_back(std::move(out));
  }
  if (lid.size() >= 3) {
    order_around(lid, normal);
    kept.push_back(std::move(lid));
  }
  faces_ = std::move(kept);
}

void Convex::cut(const Camera& camera, double near) {
  const glm::dmat4x3 p = camera.projection();
  const auto row = [&](int i) { return glm::dvec4(p[0][i], p[1][i], p[2][i], p[3][i]); };
  const glm::dvec4 s = row(0), t = row(1), q = row(2);
  const auto keep = [&](const glm::dvec4& plane, double offset) {
    cut(glm::dvec3(plane), offset - plane.w);
  };
  keep(q, near);
  keep(s + 0.5 * q, 0);
  keep(t + 0.5 * q, 0);
  keep((camera.intrinsics.width - 0.5) * q - s, 0);
  keep((camera.intrinsics.height - 0.5) * q - t, 0);
}

std::vector<glm::dvec3> Convex::corners() const {
  std::vector<glm::dvec3> out;
  for (const auto& face : faces_) out.insert(out.end(), face.begin(), face.end());
  return out;
}

}  // namespace photohull::visibility
