#include "lab/visibility/study_scenes.h"
#include "visibility/viewpoints.h"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "core/error.h"

namespace photohull::visibility {
namespace {

using glm::dvec3;

constexpr double kTurn = 2 * std::numbers::pi;

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * double(random() >> 11) * 0x1p-53;
}

/// Parts put into one mesh.
class Builder {
 public:
  using Surface = std::function<dvec3(double u, double v)>;

  /// A patch over [0, 1]^2 of 2 * columns * rows triangles.
  void patch(int columns, int rows, const Surface& at) {
    const auto first = std::uint32_t(mesh_.positions.size());
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i)
        mesh_.positions.emplace_back(at(double(i) / columns, double(j) / rows));
    const auto stride = std::uint32_t(columns + 1);
    for (std::uint32_t j = 0; j < std::uint32_t(rows); ++j)
      for (std::uint32_t i = 0; i < std::uint32_t(columns); ++i) {
        const std::uint32_t a = first + j * stride + i;
        mesh_.triangles.push_back({a, a + 1, a + stride});
        mesh_.triangles.push_back({a + 1, a + stride + 1, a + stride});
      }
  }

  void box(const dvec3& low, const dvec3& high) {
    const dvec3 d = high - low;
    const auto side = [&](const dvec3& o, const dvec3& u, const dvec3& v) {
      patch(1, 1, [&](double s, double t) { return o + s * u + t * v; });
    };
    const dvec3 x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    side(low, y, x), side(low + z, x, y);
    side(low, x, z), side(low + y, z, x);
    side(low, z, y), side(low + x, y, z);
  }

  /// A closed tube along a line.
  void tube(const dvec3& from, const dvec3& to, double radius, int columns, int rows) {
    const dvec3 along = glm::normalize(to - from);
    const dvec3 side = std::abs(along.z) < 0.7 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
    const dvec3 u = glm::normalize(glm::cross(along, side)), v = glm::cross(along, u);
    const auto rim = [&](double turn) {
      return radius * (std::cos(kTurn * turn) * u + std::sin(kTurn * turn) * v);
    };
    patch(columns, rows, [&](double s, double t) { return from + t * (to - from) + rim(s); });
    patch(columns, 1, [&](double s, double t) { return from + (1 - t) * rim(s); });
    patch(columns, 1, [&](double s, double t) { return to + t * rim(s); });
  }

  void ball(const dvec3& centre, double radius, int columns, int rows) {
    patch(columns, rows, [&](double s, double t) {
      const double a = kTurn * s, b = std::numbers::pi * t;
      return centre +
             radius * dvec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b));
    });
  }

  std::size_t triangles() const { return mesh_.triangles.size(); }
  TriMesh take() { return std::move(mesh_); }

 private:
  TriMesh mesh_;
};

/// A module of a plant: a deck on legs with stairs, a tank, and bundles of pipes a hair apart.
void add_module(Builder& b, std::mt19937_64& random, const dvec3& o) {
  b.box(o, o + dvec3(3.8, 3.8, 0.08));
  for (const double x : {0.1, 3.6})
    for (const double y : {0.1, 3.6})
      b.tube(o + dvec3(x, y, -1.2), o + dvec3(x, y, 0), 0.06, 24, 4);
  for (int step = 0; step < 12; ++step) {  // thin steps that nearly touch
    const dvec3 low = o + dvec3(0.2 + 0.14 * step, 0.2, 0.1 + 0.1 * step);
    b.box(low, low + dvec3(0.15, 0.7, 0.012));
  }
  const double radius = uniform(random, 0.3, 0.5);
  b.tube(o + dvec3(2.7, 1.2, 0.08), o + dvec3(2.7, 1.2, 1.3), radius, 64, 12);
  b.ball(o + dvec3(2.7, 1.2, 1.3), radius, 64, 24);
  for (int row = 0; row < 6; ++row)
    for (int level = 0; level < 3; ++level) {
      const double r = uniform(random, 0.03, 0.07), y = 2.0 + 0.15 * row, z = 0.25 + 0.16 * level;
      b.tube(o + dvec3(0, y, z), o + dvec3(3.8, y, z), r, 32, 20);
    }
  for (int post = 0; post < 10; ++post) {  // railing
    const double x = 0.05 + 0.4 * post;
    b.tube(o + dvec3(x, 3.75, 0.08), o + dvec3(x, 3.75, 0.6), 0.012, 8, 2);
  }
  for (const double z : {0.3, 0.6})
    b.tube(o + dvec3(0, 3.75, z), o + dvec3(3.8, 3.75, z), 0.012, 8, 8);
}

TriMesh assembly(std::size_t triangles) {
  Builder b;
  std::mt19937_64 random(1);
  b.box({-1, -1, -1.3}, {17, 17, -1.2});
  for (int floor = 0; b.triangles() < triangles; ++floor)
    for (int i = 0; i < 16 && b.triangles() < triangles; ++i)
      add_module(b, random, {4.0 * (i % 4), 4.0 * (i / 4), 1.7 * floor});
  return b.take();
}

TriMesh dense() {
  Builder b;
  b.patch(1500, 800, [](double s, double t) {
    const double a = kTurn * s, c = kTurn * t;
    const double r =
        0.9 + 0.07 * std::sin(7 * a) * std::cos(5 * c) + 0.012 * std::sin(61 * a + 40 * c);
    return dvec3((2 + r * std::cos(c)) * std::cos(a), (2 + r * std::cos(c)) * std::sin(a),
                 r * std::sin(c));
  });
  b.box({-4, -4, -1.3}, {4, 4, -1.2});
  return b.take();
}

TriMesh leaves() {
  Builder b;
  std::mt19937_64 random(2);
  b.box({-3, -3, -2.1}, {3, 3, -2});
  b.tube({0, 0, -2}, {0, 0, 0.5}, 0.12, 32, 20);
  for (int i = 0; i < 20000; ++i) {
    dvec3 d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    while (glm::dot(d, d) > 1)
      d = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    const dvec3 centre = dvec3(0, 0, 0.8) + 1.5 * d;
    const dvec3 n = glm::normalize(dvec3(uniform(random, -1, 1), uniform(random, -1, 1), 0.6));
    const dvec3 u = glm::normalize(glm::cross(n, dvec3(uniform(random, -1, 1), 1, 0.3)));
    const dvec3 v = glm::cross(n, u);
    const double size = uniform(random, 0.03, 0.07);
    // A leaf of two triangles, pointed at both ends.
    b.patch(1, 1, [&](double s, double t) {
      return centre + size * ((s + t - 1) * 1.4 * u + (s - t) * 0.6 * v);
    });
  }
  return b.take();
}

TriMesh wires() {
  Builder b;
  std::mt19937_64 random(3);
  b.box({-3, -3, -1.1}, {3, 3, -1});
  for (int i = 0; i < 140; ++i) {
    const dvec3 from(uniform(random, -2.8, 2.8), uniform(random, -2.8, 2.8),
                     uniform(random, -0.9, 2));
    const dvec3 to(uniform(random, -2.8, 2.8), uniform(random, -2.8, 2.8),
                   uniform(random, -0.9, 2));
    b.tube(from, to, uniform(random, 0.0008, 0.004), 6, 40);
  }
  return b.take();
}

TriMesh ball() {
  Builder b;
  b.ball({0, 0, 0}, 1, 208, 96);
  b.box({-3, -3, -1.15}, {3, 3, -1.05});
  return b.take();
}

struct Recipe {
  std::function<TriMesh()> make;
  dvec3 viewpoint, eye;  ///< directions from the middle of the scene
};

const std::map<std::string, Recipe>& recipes() {
  static const std::map<std::string, Recipe> all{
      {"assembly_250k", {[] { return assembly(250000); }, {-0.5, 0.4, 1.2}, {1, -0.8, 0.6}}},
      {"assembly_480k", {[] { return assembly(480000); }, {-0.5, 0.4, 1.2}, {1, -0.8, 0.6}}},
      {"dense", {dense, {-0.6, 0.5, 1}, {0.9, -0.7, 0.7}}},
      {"leaves", {leaves, {-0.5, 0.4, 1.1}, {1, -0.6, 0.5}}},
      {"wires", {wires, {-0.4, 0.5, 1.2}, {0.8, -0.9, 0.8}}},
      {"ball", {ball, {-0.5, 0.6, 1}, {0.9, -0.7, 0.7}}},
  };
  return all;
}

}  // namespace

const std::vector<std::string>& study_scene_names() {
  static const std::vector<std::string> names{"assembly_250k", "assembly_480k", "dense",
                                              "leaves",        "wires",         "ball"};
  return names;
}

StudyScene make_study_scene(const std::string& name) {
  const auto recipe = recipes().find(name);
  if (recipe == recipes().end()) {
    std::string legal;
    for (const std::string& n : study_scene_names()) legal += (legal.empty() ? "" : ", ") + n;
    throw UsageError(concat("--scenes ", name, ": expected ", legal));
  }
  StudyScene scene{name, recipe->second.make(), {}, {}, {}};
  dvec3 low(1e300), high(-1e300);
  for (const glm::vec3& p : scene.mesh.positions)
    low = glm::min(low, dvec3(p)), high = glm::max(high, dvec3(p));
  const dvec3 middle = 0.5 * (low + high);
  const double radius = 0.5 * glm::length(high - low);
  scene.viewpoint = frame_sphere(middle + 3 * radius * glm::normalize(recipe->second.viewpoint),
                                 middle, 0.8 * radius, 1024, 1024);
  const dvec3 towards = glm::normalize(recipe->second.eye);
  scene.eye = frame_sphere(middle + 2.2 * radius * towards, middle, 0.75 * radius, 800, 600);
  scene.close_eye = frame_sphere(middle + 1.1 * radius * towards, middle, 0.3 * radius, 800, 600);
  return scene;
}

}  // namespace photohull::visibility
