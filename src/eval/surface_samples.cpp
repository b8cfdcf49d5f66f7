#include "eval/surface_samples.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "eval/topology.h"

namespace photohull::eval {
namespace {

/// A number in [0, 1) from a counter (Steele, Lea, Flood, "Fast splittable pseudorandom number
/// generators", 2014), so that every sample can be drawn by itself.
double random_number(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = seed * 0xd1342543de82ef95u + (counter + 1) * 0x9e3779b97f4a7c15u;
  for (int round = 0; round < 2; ++round) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
  }
  return std::ldexp(double(z >> 11), -53);
}

}  // namespace

SurfaceSamples sample_surface(const TriMesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<double> cumulative(mesh.triangles.size());
  double area = 0;
  for (std::size_t t = 0; t < cumulative.size(); ++t)
    cumulative[t] = area += 0.5 * glm::length(area_vector(mesh, t));
  PHOTOHULL_CHECK(area > 0);
  SurfaceSamples samples;
  samples.area = area;
  samples.points.resize(count);
  samples.triangles.resize(count);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    const double wanted = (double(i) + random_number(seed, 3 * i)) / double(count) * area;
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), wanted);
    auto t = std::size_t(found - cumulative.begin());
    while (t >= cumulative.size() || cumulative[t] == (t > 0 ? cumulative[t - 1] : 0.0)) --t;
    const auto& [a, b, c] = mesh.triangles[t];
    const double u = std::sqrt(random_number(seed, 3 * i + 1));
    const double v = random_number(seed, 3 * i + 2);
    samples.points[i] = (1 - u) * mesh.world(a) + u * ((1 - v) * mesh.world(b) + v * mesh.world(c));
    samples.triangles[i] = std::uint32_t(t);
  });
  return samples;
}

SurfaceSamples thin_points(const TriMesh& cloud, double cell) {
  PHOTOHULL_CHECK(cell > 0 && !cloud.positions.empty());
  glm::dvec3 low(INFINITY);
  for (const glm::vec3& p : cloud.positions) low = glm::min(low, glm::dvec3(p));
  struct Entry {
    std::array<double, 3> cell;
    std::uint32_t point;
  };
  std::vector<Entry> entries(cloud.positions.size());
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    const glm::dvec3 c = glm::floor((glm::dvec3(cloud.positions[i]) - low) / cell);
    entries[i] = {{c.x, c.y, c.z}, i};
  }
  tbb::parallel_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.point < b.point;
  });
  SurfaceSamples samples;
  for (std::size_t i = 0; i < entries.size();) {
    std::size_t end = i;
    glm::dvec3 sum(0);
    for (; end < entries.size() && entries[end].cell == entries[i].cell; ++end)
      sum += glm::dvec3(cloud.positions[entries[end].point]);
    samples.points.push_back(cloud.origin + sum / double(end - i));
    i = end;
  }
  return samples;
}

}  // namespace photohull::eval
