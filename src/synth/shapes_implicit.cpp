// Shapes that are the zero set of a function of space.
#include <cmath>
#include <numbers>

#include "synth/field_mesh.h"
#include "synth/shape_makers.h"

namespace photohull::synth {
namespace {

/// The gyroid's function from the sines and cosines of the three angles.
double gyroid(const glm::dvec3& s, const glm::dvec3& c, double distance, double k, double radius,
              double wall) {
  const double g = s.x * c.y + s.y * c.z + s.z * c.x;
  const double sheet = (g * g - wall * wall) / (2 * wall * 1.5 * k);
  const double ball = distance - radius;
  // The larger of the two, rounded where they meet.
  const double rounding = 0.04 * radius, apart = sheet - ball;
  return 0.5 * (sheet + ball + std::sqrt(apart * apart + rounding * rounding));
}

double wave_number(const ShapeValues& v) {
  return std::numbers::pi * v.at("cells") / v.at("radius");
}

}  // namespace

double gyroid_field(const glm::dvec3& p, const ShapeValues& v) {
  const double k = wave_number(v);
  return gyroid(sin(k * p), cos(k * p), length(p), k, v.at("radius"), v.at("thickness"));
}

TriMesh make_gyroid(const ShapeValues& v) {
  const double radius = v.at("radius"), wall = v.at("thickness"), k = wave_number(v);
  GridSpec grid;
  const int bricks = 24 + int(8 * v.at("cells"));
  grid.bricks = glm::ivec3(bricks);
  grid.voxel_size = 2.1 * radius / (bricks * kBrickEdge);
  grid.origin = -0.5 * grid.voxel_size * glm::dvec3(grid.voxels() - 1);
  // The lattice is a cube about the origin: one table serves all axes.
  std::vector<double> place, sine, cosine;
  for (int i = 0; i < bricks * kBrickEdge; ++i) {
    place.push_back(grid.origin.x + grid.voxel_size * i);
    sine.push_back(std::sin(k * place.back()));
    cosine.push_back(std::cos(k * place.back()));
  }
  const auto pick = [](const std::vector<double>& table, const glm::ivec3& i) {
    return glm::dvec3(table[i.x], table[i.y], table[i.z]);
  };
  return mesh_of_field(
      [&](const glm::ivec3& i) {
        return gyroid(pick(sine, i), pick(cosine, i), length(pick(place, i)), k, radius, wall);
      },
      [&](const glm::dvec3& p) { return gyroid_field(p, v); }, grid);
}

}  // namespace photohull::synth
