#include "mesh/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "core/error.h"
#include "mesh/convex_hull.h"
#include "mesh/oriented_box.h"

namespace photohull {
namespace {

using Corners = std::array<glm::dvec3, 3>;

constexpr int kMostSections = 10000;
constexpr double kMostVoxels = 3;  // standard deviation of what no camera sees

/// Positions in world coordinates, whose places are those of the mesh's triangles.
struct Shape {
  const TriMesh& mesh;
  std::vector<glm::dvec3> points;

  Corners corners(std::size_t triangle) const {
    const auto& t = mesh.triangles[triangle];
    return {points[t[0]], points[t[1]], points[t[2]]};
  }
};

/// What is measured of a shape.
struct Figures {
  double volume = 0, area = 0, low = 0, high = 0, box_volume = 0, hull_volume = 0;
  Box box;
  std::vector<double> sections;
};

/// x with erf(x) = c, by bisection; c in (0, 1).
double inverse_erf(double c) {
  double low = 0, high = 6;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (std::erf(middle) < c ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// In voxels.
double standard_deviation(float confidence) {
  const double least = std::erf(1 / (std::sqrt(2.0) * kMostVoxels));
  const double c = std::clamp(double(confidence), least, 1 - 1e-12);
  return 1 / (std::sqrt(2.0) * inverse_erf(c));
}

/// The shape with its vertices moved along their normals, by `side` standard deviations.
Shape moved(const TriMesh& mesh, double voxel_size, double side) {
  Shape shape{mesh, {}};
  const bool known = mesh.confidence.size() == mesh.positions.size() &&
                     mesh.normals.size() == mesh.positions.size();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    glm::dvec3 p = mesh.world(v);
    if (known && side != 0)
      p += side * voxel_size * standard_deviation(mesh.confidence[v]) * glm::dvec3(mesh.normals[v]);
    shape.points.push_back(p);
  }
  return shape;
}

double signed_volume(const Corners& c, const glm::dvec3& from) {
  return glm::dot(c[0] - from, glm::cross(c[1] - from, c[2] - from)) / 6;
}

double hull_volume(const std::vector<glm::dvec3>& points) {
  double volume = 0;
  for (const auto& t : convex_hull(points))
    volume += signed_volume({points[t[0]], points[t[1]], points[t[2]]}, points[0]);
  return volume;
}

/// Twice the area that a triangle's cut with the plane axis . x = at adds to the cross-section's:
/// cuts have the inside on their left, seen against the axis.
double cut_area(const Corners& c, const glm::dvec3& axis, double at, const glm::dvec3& from) {
  std::array<double, 3> h;
  for (std::size_t i = 0; i < 3; ++i) h[i] = glm::dot(axis, c[i]) - at;
  glm::dvec3 enter{0.0}, leave{0.0};
  int crossings = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if ((h[i] < 0) == (h[j] < 0)) continue;
    (h[i] < 0 ? leave : enter) = c[i] + h[i] / (h[i] - h[j]) * (c[j] - c[i]);
    ++crossings;
  }
  if (crossings != 2) return 0;
  return glm::dot(axis, glm::cross(enter - from, leave - from));
}

std::vector<double> section_positions(double low, double high, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(low + (high - low) * (i + 0.5) / count);
  return out;
}

/// Each triangle meets few of the planes, which ascend.
std::vector<double> section_areas(const Shape& shape, const glm::dvec3& axis,
                                  const std::vector<double>& positions) {
  std::vector<double> areas(positions.size());
  for (std::size_t t = 0; t < shape.mesh.triangles.size(); ++t) {
    const Corners c = shape.corners(t);
    const auto [low, high] =
        std::minmax({glm::dot(axis, c[0]), glm::dot(axis, c[1]), glm::dot(axis, c[2])});
    auto at = std::lower_bound(positions.begin(), positions.end(), low);
    for (; at != positions.end() && *at <= high; ++at)
      areas[std::size_t(at - positions.begin())] += 0.5 * cut_area(c, axis, *at, shape.points[0]);
  }
  return areas;
}

Figures figures_of(const Shape& shape, const glm::dvec3& axis,
                   const std::vector<double>& positions) {
  Figures f;
  f.low = 1e300, f.high = -1e300;
  f.box = {glm::dvec3(1e300), glm::dvec3(-1e300)};
  for (std::size_t t = 0; t < shape.mesh.triangles.size(); ++t) {
    const Corners c = shape.corners(t);
    f.volume += signed_volume(c, shape.points[0]);
    f.area += 0.5 * glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
    for (const glm::dvec3& p : c) {
      f.low = std::min(f.low, glm::dot(axis, p)), f.high = std::max(f.high, glm::dot(axis, p));
      f.box = {glm::min(f.box.min, p), glm::max(f.box.max, p)};
    }
  }
  const glm::dvec3 size = f.box.size();
  f.box_volume = size.x * size.y * size.z;
  f.hull_volume = hull_volume(shape.points);
  f.sections = section_areas(shape, axis, positions);
  return f;
}

/// Every edge runs as often one way as the other; vertices at the same place count as one.
bool is_closed(const TriMesh& mesh) {
  using Place = std::tuple<float, float, float>;
  std::map<Place, std::uint32_t> places;
  std::vector<std::uint32_t> joined;
  for (const glm::vec3& p : mesh.positions)
    joined.push_back(
        places.emplace(Place{p.x, p.y, p.z}, std::uint32_t(joined.size())).first->second);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = joined[t[i]], b = joined[t[(i + 1) % 3]];
      if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

double unseen_share(const TriMesh& mesh) {
  if (mesh.confidence.empty()) return 0;
  double all = 0, unseen = 0;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    const double area = glm::length(glm::cross(b - a, c - a));
    all += area;
    for (const std::uint32_t v : t) unseen += mesh.confidence[v] > 0 ? 0 : area / 3;
  }
  return all > 0 ? unseen / all : 0;
}

glm::dvec3 axis_of(MeasureAxis axis, const glm::dvec3& up) {
  switch (axis) {
    case MeasureAxis::kUp:
      break;
    case MeasureAxis::kX:
      return {1, 0, 0};
    case MeasureAxis::kY:
      return {0, 1, 0};
    case MeasureAxis::kZ:
      return {0, 0, 1};
  }
  return glm::normalize(up);
}

}  // namespace

const char* to_string(MeasureAxis axis) {
  constexpr const char* names[] = {"up", "x", "y", "z"};
  return names[int(axis)];
}

void describe(Described& to, MeasureOptions& o) {
  to.choice("axis", &o.axis,
            std::array{MeasureAxis::kUp, MeasureAxis::kX, MeasureAxis::kY, MeasureAxis::kZ},
            "of the height and of cross-sections: up (the world's axis that is upward in most "
            "photographs), or one of the world's");
  to.number("sections", &o.sections, from_to(0, kMostSections), "",
            "cross-sections, in the middle of as many slabs of the same height");
}

void MeasureOptions::validate() const { check_options(*this); }

Measurements measure(const TriMesh& mesh, const glm::dvec3& up, double voxel_size,
                     const MeasureOptions& options) {
  options.validate();
  if (mesh.triangles.empty()) throw Error("there is nothing to measure: the mesh has no triangles");
  Measurements m;
  m.axis = axis_of(options.axis, up);
  m.closed = is_closed(mesh);
  const Shape middle = moved(mesh, voxel_size, 0);
  const Figures extent = figures_of(middle, m.axis, {});
  std::vector<double> positions;
  if (m.closed) positions = section_positions(extent.low, extent.high, options.sections);
  const Figures f = figures_of(middle, m.axis, positions),
                out = figures_of(moved(mesh, voxel_size, 1), m.axis, positions),
                in = figures_of(moved(mesh, voxel_size, -1), m.axis, positions);
  const auto with = [](double value, double outer, double inner) {
    return Measured{value, 0.5 * std::abs(outer - inner)};
  };
  if (m.closed) m.volume = with(f.volume, out.volume, in.volume);
  m.area = with(f.area, out.area, in.area);
  m.height = with(f.high - f.low, out.high - out.low, in.high - in.low);
  m.box = f.box;
  m.box_volume = with(f.box_volume, out.box_volume, in.box_volume);
  m.hull_volume = with(f.hull_volume, out.hull_volume, in.hull_volume);
  m.oriented = oriented_box(middle.points);
  for (std::size_t i = 0; i < positions.size(); ++i)
    m.sections.push_back({positions[i], with(f.sections[i], out.sections[i], in.sections[i])});
  m.unseen = unseen_share(mesh);
  return m;
}

}  // namespace photohull
