#include "mesh/convex_hull.h"

#include <algorithm>
#include <map>
#include <utility>

namespace photohull {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr double kOnPlane = 1e-9;  // of the extent

struct Face {
  Triangle corners;
  glm::dvec3 normal{0.0};  // unit, outward
  double offset = 0;
  std::vector<std::uint32_t> outside;  // points above it that no other face has
  bool alive = true;
};

class QuickHull {
 public:
  explicit QuickHull(std::span<const glm::dvec3> points) : points_(points) {}

  std::vector<Triangle> run() {
    if (!begin()) return {};
    for (std::size_t f = 0; f < faces_.size(); ++f)
      while (faces_[f].alive && !faces_[f].outside.empty()) add_farthest(f);
    std::vector<Triangle> out;
    for (const Face& face : faces_)
      if (face.alive) out.push_back(face.corners);
    return out;
  }

 private:
  double height(const Face& face, std::uint32_t p) const {
    return glm::dot(face.normal, points_[p]) - face.offset;
  }

  std::uint32_t add_face(const Triangle& t) {
    Face face{t};
    const glm::dvec3 normal =
        glm::cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
    const double length = glm::length(normal);
    face.normal = length > 0 ? normal / length : normal;
    face.offset = glm::dot(face.normal, points_[t[0]]);
    const std::uint32_t index = std::uint32_t(faces_.size());
    for (int i = 0; i < 3; ++i) beside_[{t[std::size_t(i)], t[std::size_t((i + 1) % 3)]}] = index;
    faces_.push_back(std::move(face));
    return index;
  }

  template <typename Measure>
  std::uint32_t farthest(const Measure& measure) const {
    std::uint32_t best = 0;
    double most = -1;
    for (std::uint32_t p = 0; p < points_.size(); ++p)
      if (const double m = measure(points_[p]); m > most) most = m, best = p;
    return best;
  }

  /// A tetrahedron of points that lie far apart; false where there is none.
  bool begin() {
    if (points_.size() < 4) return false;
    const glm::dvec3 first = points_[0];
    const std::uint32_t a = farthest([&](const glm::dvec3& p) { return glm::distance(p, first); });
    const glm::dvec3 pa = points_[a];
    const std::uint32_t b = farthest([&](const glm::dvec3& p) { return glm::distance(p, pa); });
    const double extent = glm::distance(pa, points_[b]);
    if (!(extent > 0)) return false;
    tolerance_ = kOnPlane * extent;
    const glm::dvec3 along = (points_[b] - pa) / extent;
    const auto from_line = [&](const glm::dvec3& p) {
      return glm::length(glm::cross(p - pa, along));
    };
    std::uint32_t c = farthest(from_line);
    if (from_line(points_[c]) <= tolerance_) return false;
    const glm::dvec3 normal = glm::normalize(glm::cross(points_[b] - pa, points_[c] - pa));
    const auto from_plane = [&](const glm::dvec3& p) { return std::abs(glm::dot(p - pa, normal)); };
    const std::uint32_t d = farthest(from_plane);
    if (from_plane(points_[d]) <= tolerance_) return false;
    std::uint32_t low = b;
    if (glm::dot(points_[d] - pa, normal) > 0) std::swap(low, c);  // d is behind a, low, c
    for (const Triangle& t :
         {Triangle{a, low, c}, Triangle{a, c, d}, Triangle{c, low, d}, Triangle{low, a, d}})
      add_face(t);
    std::vector<std::uint32_t> all(points_.size());
    for (std::uint32_t p = 0; p < all.size(); ++p) all[p] = p;
    deal_out(all, 0);
    return true;
  }

  /// Gives each point to the first face from `from` on that it is above.
  void deal_out(const std::vector<std::uint32_t>& points, std::size_t from) {
    for (const std::uint32_t p : points)
      for (std::size_t f = from; f < faces_.size(); ++f)
        if (height(faces_[f], p) > tolerance_) {
          faces_[f].outside.push_back(p);
          break;
        }
  }

  /// Faces that a point sees, which are all within reach of one of them.
  std::vector<std::uint32_t> seen_from(std::uint32_t point, std::uint32_t start) {
    std::vector<std::uint32_t> seen = {start};
    faces_[start].alive = false;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Triangle t = faces_[seen[i]].corners;
      for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t other = beside_.at({t[(side + 1) % 3], t[side]});
        if (!faces_[other].alive || !(height(faces_[other], point) > tolerance_)) continue;
        faces_[other].alive = false;
        seen.push_back(other);
      }
    }
    return seen;
  }

  void add_farthest(std::size_t face) {
    const std::vector<std::uint32_t>& above = faces_[face].outside;
    const std::uint32_t point = *std::ranges::max_element(
        above, {}, [&](std::uint32_t p) { return height(faces_[face], p); });
    std::vector<std::uint32_t> homeless;
    std::vector<Edge> horizon;
    for (const std::uint32_t f : seen_from(point, std::uint32_t(face))) {
      const Triangle t = faces_[f].corners;
      for (std::size_t side = 0; side < 3; ++side) {
        const Edge edge{t[side], t[(side + 1) % 3]};
        if (faces_[beside_.at({edge.second, edge.first})].alive) horizon.push_back(edge);
      }
      for (const std::uint32_t p : std::exchange(faces_[f].outside, {}))
        if (p != point) homeless.push_back(p);
    }
    const std::size_t from = faces_.size();
    for (const Edge& edge : horizon) add_face({edge.first, edge.second, point});
    deal_out(homeless, from);
  }

  std::span<const glm::dvec3> points_;
  double tolerance_ = 0;
  std::vector<Face> faces_;
  std::map<Edge, std::uint32_t> beside_;  // the face that runs along an edge in this direction
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const glm::dvec3> points) {
  return QuickHull(points).run();
}

}  // namespace photohull
