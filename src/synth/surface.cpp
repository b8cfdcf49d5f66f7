#include "synth/surface.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "io/mesh/read_mesh.h"

namespace photohull::synth {
namespace {

constexpr std::size_t kMostTriangles = 50'000'000;
constexpr float kSmooth = 0.8660254f;  ///< cosine of 30 degrees

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float size = length(v);
  return size > 0 ? v / size : fallback;
}

void move(const GeometrySpec& g, TriMesh& mesh) {
  const glm::dmat3 linear = turn_by(g.rotate) * g.scale;
  for (glm::vec3& p : mesh.positions) p = glm::vec3(linear * glm::dvec3(p));
  mesh.origin = linear * mesh.origin + g.translate;
}

/// Twice the area vectors' directions; doubles, since triangles may be tiny.
std::vector<glm::vec3> face_normals(const TriMesh& mesh, double& area) {
  std::vector<glm::vec3> normals;
  normals.reserve(mesh.triangles.size());
  area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 p(mesh.positions[a]);
    const glm::dvec3 n =
        cross(glm::dvec3(mesh.positions[b]) - p, glm::dvec3(mesh.positions[c]) - p);
    const double size = length(n);
    area += size / 2;
    normals.push_back(size > 0 ? glm::vec3(n / size) : glm::vec3(0, 0, 1));
  }
  return normals;
}

double corner_angle(const TriMesh& mesh, std::size_t triangle, int corner) {
  const auto& t = mesh.triangles[triangle];
  const glm::dvec3 p(mesh.positions[t[corner]]);
  const glm::dvec3 u = glm::dvec3(mesh.positions[t[(corner + 1) % 3]]) - p;
  const glm::dvec3 v = glm::dvec3(mesh.positions[t[(corner + 2) % 3]]) - p;
  return std::atan2(length(cross(u, v)), dot(u, v));
}

/// Corners (triangle * 3 + corner) around every vertex.
struct Stars {
  std::vector<std::size_t> first;
  std::vector<std::size_t> corners;

  explicit Stars(const TriMesh& mesh) : first(mesh.positions.size() + 1) {
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t v : t) ++first[v + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    corners.resize(3 * mesh.triangles.size());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < corners.size(); ++i)
      corners[next[mesh.triangles[i / 3][i % 3]]++] = i;
  }
};

/// Means of the normals around a corner, weighted by angle, over faces that meet it smoothly.
void set_corner_normals(const Stars& stars, Surface& s) {
  constexpr std::size_t kLargestStar = 4096;  // larger ones would take quadratic time
  s.normals.resize(s.mesh.triangles.size());
  for (std::size_t v = 0; v + 1 < stars.first.size(); ++v) {
    const std::size_t begin = stars.first[v], end = stars.first[v + 1];
    std::vector<float> angles;
    for (std::size_t i = begin; i < end; ++i)
      angles.push_back(
          float(corner_angle(s.mesh, stars.corners[i] / 3, int(stars.corners[i] % 3))));
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 own = s.face_normals[stars.corners[i] / 3];
      glm::vec3 sum(0);
      for (std::size_t j = begin; j < end && end - begin <= kLargestStar; ++j) {
        const glm::vec3 other = s.face_normals[stars.corners[j] / 3];
        if (dot(own, other) > kSmooth) sum += angles[j - begin] * other;
      }
      s.normals[stars.corners[i] / 3][stars.corners[i] % 3] = unit_or(sum, own);
    }
  }
}

/// Patches of faces that meet smoothly across edges, numbered in the order of their first face.
std::vector<std::uint32_t> find_patches(const Surface& s) {
  struct Edge {
    std::uint64_t key;
    std::uint32_t triangle;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * s.mesh.triangles.size());
  for (std::uint32_t i = 0; i < s.mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t a = s.mesh.triangles[i][k], b = s.mesh.triangles[i][(k + 1) % 3];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), i});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  DisjointSets joined(s.mesh.triangles.size());
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const Edge &a = edges[i - 1], &b = edges[i];
    if (a.key == b.key && dot(s.face_normals[a.triangle], s.face_normals[b.triangle]) > kSmooth)
      joined.unite(a.triangle, b.triangle);
  }
  std::map<std::uint32_t, std::uint32_t> numbers;
  std::vector<std::uint32_t> patches;
  for (std::uint32_t i = 0; i < joined.size(); ++i)
    patches.push_back(numbers.emplace(joined.root(i), std::uint32_t(numbers.size())).first->second);
  return patches;
}

}  // namespace

glm::dmat3 turn_by(const glm::dvec3& degrees) {
  glm::dmat4 turn(1);
  for (int axis = 2; axis >= 0; --axis) {
    glm::dvec3 around(0);
    around[axis] = 1;
    turn = glm::rotate(turn, glm::radians(degrees[axis]), around);
  }
  return glm::dmat3(turn);
}

Box tight_box(const TriMesh& mesh) {
  Box box{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) {
      box.min = min(box.min, mesh.world(i));
      box.max = max(box.max, mesh.world(i));
    }
  return box;
}

glm::vec3 Surface::normal(const Hit& hit) const {
  const auto& n = normals[hit.triangle];
  const float u = float(hit.u), v = float(hit.v);
  return unit_or((1 - u - v) * n[0] + u * n[1] + v * n[2], face_normals[hit.triangle]);
}

Surface make_surface(TriMesh mesh, const std::string& source) {
  if (mesh.triangles.empty())
    throw Error(source + ": it has no faces; give a mesh of triangles or polygons");
  if (mesh.triangles.size() > kMostTriangles)
    throw Error(concat(source, ": ", mesh.triangles.size(), " triangles are more than ",
                       kMostTriangles, "; simplify it"));
  Surface s;
  s.mesh = std::move(mesh);
  s.mesh.normals.clear(), s.mesh.colours.clear(), s.mesh.confidence.clear();
  s.rays = std::make_unique<RayScene>(s.mesh);  // checks that coordinates are finite
  s.box = tight_box(s.mesh);
  s.diagonal = s.box.diagonal();
  s.own = {glm::dmat3(1.0), s.box.center(), s.box.size(), s.diagonal};
  double area = 0;
  s.face_normals = face_normals(s.mesh, area);
  if (!(s.diagonal > 0) || !(area > 1e-12 * s.diagonal * s.diagonal))
    throw Error(source + ": its faces have no area; give a mesh that is not a point or a line");
  set_corner_normals(Stars(s.mesh), s);
  s.patches = find_patches(s);
  return s;
}

TriMesh make_mesh(const GeometrySpec& geometry) {
  TriMesh mesh = geometry.mesh.empty()
                     ? make_shape(*find_shape(geometry.shape), geometry.parameters)
                     : read_mesh(geometry.mesh);
  move(geometry, mesh);
  return mesh;
}

Surface make_surface(const GeometrySpec& geometry) {
  return make_surface(make_mesh(geometry), geometry.mesh.empty() ? geometry.shape : geometry.mesh);
}

Surface make_surface(const GeometrySpec& geometry, const glm::dvec3& turn) {
  Surface before = make_surface(geometry);
  if (turn == glm::dvec3(0.0)) return before;
  const glm::dmat3 rotation = turn_by(turn);
  TriMesh mesh = std::move(before.mesh);
  for (glm::vec3& p : mesh.positions) p = glm::vec3(rotation * glm::dvec3(p));
  mesh.origin = before.own.middle + rotation * (mesh.origin - before.own.middle);
  Surface turned = make_surface(std::move(mesh), "sheet.turn");
  turned.own = before.own;
  turned.own.rotation = glm::transpose(rotation);
  return turned;
}

}  // namespace photohull::synth
