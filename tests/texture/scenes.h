// Spheres with known colours, and photographs of them.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "core/mesh_texture.h"
#include "core/prepared_view.h"
#include "support/cameras.h"
#include "support/ray_cast.h"

namespace photohull::texture {

using Colour = std::function<glm::dvec3(const glm::dvec3&)>;  ///< linear, at a point

struct Sphere {
  glm::dvec3 centre{0.0};
  double radius = 1;
  Colour colour;
};

/// An octahedron divided `levels` times, on a sphere; with colours of the true sphere below.
inline TriMesh mesh_of(const Sphere& sphere, int levels, double grown = 1) {
  TriMesh mesh;
  std::vector<glm::dvec3> points = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                    {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, fresh] =
          middles.try_emplace(std::minmax(a, b), std::uint32_t(points.size()));
      if (fresh) points.push_back(glm::normalize(points[a] + points[b]));
      return found->second;
    };
    std::vector<std::array<std::uint32_t, 3>> fine;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      fine.insert(fine.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = fine;
  }
  for (const glm::dvec3& p : points) {
    mesh.positions.emplace_back(sphere.centre + sphere.radius * grown * p);
    mesh.normals.emplace_back(p);
    mesh.colours.emplace_back(sphere.colour(sphere.centre + sphere.radius * p));
  }
  return mesh;
}

inline TriMesh joined(const TriMesh& a, const TriMesh& b) {
  TriMesh out = a;
  const auto first = std::uint32_t(a.positions.size());
  out.positions.insert(out.positions.end(), b.positions.begin(), b.positions.end());
  out.normals.insert(out.normals.end(), b.normals.begin(), b.normals.end());
  out.colours.insert(out.colours.end(), b.colours.begin(), b.colours.end());
  for (const auto& t : b.triangles)
    out.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return out;
}

/// The nearest sphere's colour times `gain`, or the background.
inline PreparedView photograph(const std::vector<Sphere>& spheres, const Camera& camera,
                               const glm::dvec3& background, double gain = 1) {
  PreparedView view;
  view.camera = camera;
  view.image = test::ray_cast(
      camera,
      [&](const glm::dvec3& eye, const glm::dvec3& ray) {
        double nearest = std::numeric_limits<double>::infinity();
        glm::dvec3 colour = background;
        for (const Sphere& s : spheres) {
          const glm::dvec3 to = eye - s.centre;
          const double b = glm::dot(to, ray), d = b * b - glm::dot(to, to) + s.radius * s.radius;
          const double t = -b - std::sqrt(std::max(d, 0.0));
          if (d < 0 || t < 0 || t > nearest) continue;
          nearest = t;
          colour = gain * s.colour(eye + t * ray);
        }
        return colour;
      },
      2);
  return view;
}

inline Colour plain(const glm::dvec3& colour) {
  return [colour](const glm::dvec3&) { return colour; };
}

/// Bilinear, linear light, at weights of a triangle's corners.
inline glm::vec3 colour_at(const MeshTexture& texture, std::size_t face,
                           const glm::dvec3& weights) {
  const RgbImage& page = texture.pages[texture.page[face]];
  glm::dvec2 at(0);
  for (int i = 0; i < 3; ++i) at += weights[i] * glm::dvec2(texture.corners[face][std::size_t(i)]);
  at = at * glm::dvec2(page.width, page.height) - 0.5;
  const glm::ivec2 base(glm::floor(at));
  const glm::dvec2 f = at - glm::dvec2(base);
  glm::dvec3 sum(0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int x = std::clamp(base.x + i, 0, page.width - 1);
      const int y = std::clamp(base.y + j, 0, page.height - 1);
      const std::uint8_t* p = &page.rgb[3 * (std::size_t(y) * page.width + std::size_t(x))];
      const double w = (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y);
      for (int c = 0; c < 3; ++c) sum[c] += w * linear_from_srgb(p[c] / 255.0);
    }
  return glm::vec3(sum);
}

/// Greatest difference in codes of 8-bit sRGB.
inline double codes_apart(const glm::dvec3& a, const glm::dvec3& b) {
  double most = 0;
  for (int c = 0; c < 3; ++c)
    most = std::max(most, 255 * std::abs(srgb_from_linear(a[c]) - srgb_from_linear(b[c])));
  return most;
}

}  // namespace photohull::texture
