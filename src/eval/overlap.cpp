#include "eval/overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "eval/topology.h"

namespace photohull::eval {
namespace {

constexpr std::size_t kMostCrossings = std::size_t(1) << 27;

struct Crossing {
  std::uint32_t column;
  std::int8_t turn;  ///< +1 where the line enters, going up
  double z;
};

/// The grid of columns, in a frame at `origin` that both meshes share.
struct Columns {
  glm::dvec3 origin{0.0};
  double cell = 0;
  glm::ivec2 count{0};

  glm::dvec2 centre(int x, int y) const {
    return glm::dvec2(origin) + cell * (glm::dvec2(x, y) + 0.5);
  }
};

/// On which side of the line from a to b the point p lies: +1 left, -1 right, 0 when a = b. Swapped
/// ends give the opposite, to the last bit; a point on the line counts as moved by (-e^2, e), which
/// is left of every line taken from its lower end to its higher one.
int side_of(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
  if (a == b) return 0;
  if (a.x > b.x || (a.x == b.x && a.y > b.y)) return -side_of(b, a, p);
  const double cross = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  return cross >= 0 ? 1 : -1;
}

double height_at(const std::array<glm::dvec3, 3>& t, const glm::dvec2& p) {
  const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
  const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
  if (n.z == 0) return 0.5 * (low + high);
  const double z = t[0].z - (n.x * (p.x - t[0].x) + n.y * (p.y - t[0].y)) / n.z;
  return std::clamp(z, low, high);
}

/// First and last column that the interval can touch; first > last when none.
glm::ivec2 range_of(double low, double high, double origin, double cell, int count) {
  const double first = std::floor((low - origin) / cell - 0.5);
  const double last = std::ceil((high - origin) / cell - 0.5);
  return {int(std::clamp(first, 0.0, double(count))), int(std::clamp(last, -1.0, count - 1.0))};
}

/// Where the columns' lines meet the mesh, sorted by column and height; false when there are too
/// many.
bool find_crossings(const TriMesh& mesh, const Columns& columns, std::vector<Crossing>& found) {
  for (const auto& corners : mesh.triangles) {
    std::array<glm::dvec3, 3> t;
    for (int i = 0; i < 3; ++i) t[i] = mesh.world(corners[i]);
    const glm::dvec3 low = glm::min(glm::min(t[0], t[1]), t[2]);
    const glm::dvec3 high = glm::max(glm::max(t[0], t[1]), t[2]);
    const glm::ivec2 xs = range_of(low.x, high.x, columns.origin.x, columns.cell, columns.count.x);
    const glm::ivec2 ys = range_of(low.y, high.y, columns.origin.y, columns.cell, columns.count.y);
    for (int y = ys[0]; y <= ys[1]; ++y)
      for (int x = xs[0]; x <= xs[1]; ++x) {
        const glm::dvec2 p = columns.centre(x, y);
        const int side = side_of(t[0], t[1], p);
        if (side == 0 || side_of(t[1], t[2], p) != side || side_of(t[2], t[0], p) != side) continue;
        // A face that is counter-clockwise from above looks up: there the line leaves.
        found.push_back(
            {std::uint32_t(y * columns.count.x + x), std::int8_t(-side), height_at(t, p)});
      }
    if (found.size() > kMostCrossings) return false;
  }
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
    if (a.column != b.column) return a.column < b.column;
    return a.z != b.z ? a.z < b.z : a.turn < b.turn;
  });
  return true;
}

/// Adds up one column's lengths inside the first, the second, both, either.
void add_column(const Crossing*& a, const Crossing* a_end, const Crossing*& b,
                const Crossing* b_end, std::uint32_t column, Overlap& sums) {
  int winding_a = 0, winding_b = 0;
  double previous = 0;
  while (true) {
    const bool more_a = a != a_end && a->column == column;
    const bool more_b = b != b_end && b->column == column;
    if (!more_a && !more_b) return;
    const bool take_a = more_a && (!more_b || a->z <= b->z);
    const double z = take_a ? a->z : b->z;
    const double length = z - previous;
    if (winding_a != 0) sums.first += length;
    if (winding_b != 0) sums.second += length;
    if (winding_a != 0 && winding_b != 0) sums.intersection += length;
    if (winding_a != 0 || winding_b != 0) sums.together += length;
    previous = z;
    if (take_a)
      winding_a += (a++)->turn;
    else
      winding_b += (b++)->turn;
  }
}

Columns fit_columns(const TriMesh& first, const TriMesh& second, int columns) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const TriMesh* mesh : {&first, &second})
    for (const auto& corners : mesh->triangles)
      for (const std::uint32_t v : corners) {
        low = glm::min(low, mesh->world(v));
        high = glm::max(high, mesh->world(v));
      }
  const glm::dvec3 size = high - low;
  Columns result;
  result.origin = low;
  result.cell = std::max(size.x, size.y) / columns;
  for (int i = 0; i < 2; ++i)
    result.count[i] = std::clamp(int(std::ceil(size[i] / result.cell - 1e-9)), 1, columns);
  return result;
}

std::string open_edges(const char* which, const Closedness& c) {
  return concat("the ", which, " is not closed: ", c.open_edges, " of its ", c.edges,
                " edges have no counterpart");
}

}  // namespace

Closedness check_closed(const TriMesh& mesh) {
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh, joined_vertices(mesh));
  Closedness result;
  for (std::size_t i = 0; i < edges.size();) {
    const std::uint64_t key = edges[i].key;
    std::int64_t balance = 0;
    for (; i < edges.size() && edges[i].key == key; ++i) balance += edges[i].ascending ? 1 : -1;
    ++result.edges;
    result.open_edges += balance != 0;
  }
  return result;
}

Overlap measure_overlap(const TriMesh& first, const TriMesh& second, int columns) {
  PHOTOHULL_CHECK(columns >= 1 && columns <= 4096);
  Overlap result;
  const std::array<std::pair<const char*, const TriMesh*>, 2> meshes = {std::pair{"result", &first},
                                                                        {"truth", &second}};
  for (const auto& [name, mesh] : meshes) {
    const Closedness closedness = check_closed(*mesh);
    if (closedness.closed()) continue;
    result.reason = open_edges(name, closedness);
    return result;
  }
  const Columns grid = fit_columns(first, second, columns);
  std::vector<Crossing> a, b;
  if (!(grid.cell > 0)) {
    result.reason = "neither the result nor the truth has a volume";
    return result;
  }
  if (!find_crossings(first, grid, a) || !find_crossings(second, grid, b)) {
    result.reason = concat("there are more than ", kMostCrossings, " surfaces above each other");
    return result;
  }
  const Crossing *at_a = a.data(), *at_b = b.data();
  const Crossing *end_a = at_a + a.size(), *end_b = at_b + b.size();
  const auto count = std::uint32_t(grid.count.x * grid.count.y);
  for (std::uint32_t column = 0; column < count; ++column)
    add_column(at_a, end_a, at_b, end_b, column, result);
  for (double* sum : {&result.first, &result.second, &result.intersection, &result.together})
    *sum *= grid.cell * grid.cell;
  if (!(result.together > 0)) {
    result.reason = "neither the result nor the truth has a volume";
    return result;
  }
  result.known = true;
  result.iou = result.intersection / result.together;
  return result;
}

}  // namespace photohull::eval
