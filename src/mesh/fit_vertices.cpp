// Based on: H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W. Stuetzle, "Mesh optimization",
// SIGGRAPH 1993 [Hoppe93]: positions by linear least squares for fixed feet of the points, here
// with distances to planes (Y. Chen, G. Medioni, "Object modelling by registration of multiple
// range images", 1992 [ChenMedioni92]) and by conjugate gradients.
#include "mesh/fit_vertices.h"

#include <algorithm>
#include <cmath>

namespace photohull {
namespace {

/// Weight of a vertex's own squared move beside the squared distances around it: what these leave
/// open, such as moves within a plane, stays small.
constexpr double kStay = 0.02;
constexpr int kMostSteps = 100;
constexpr double kPrecision = 1e-3;  // of the residual, beside the right-hand side

using Moves = std::vector<glm::dvec3>;

/// The least-squares problem: moves x, one for each vertex, with A x = b.
class Problem {
 public:
  Problem(const std::vector<FitPoint>& points, const TriMesh& simple,
          const std::vector<std::uint8_t>& fixed)
      : mesh_(simple),
        fixed_(fixed),
        stay_(simple.positions.size()),
        diagonal_(stay_.size(), glm::dvec3(0)),
        right_(stay_.size(), glm::dvec3(0)) {
    terms_.reserve(points.size());
    for (const FitPoint& p : points) add(p);
    double mean = 0;
    for (const double s : stay_) mean += s / double(stay_.size());
    for (std::size_t v = 0; v < stay_.size(); ++v) {
      stay_[v] =
          kStay * std::max(stay_[v], 0.01 * mean);  // where hardly a point is: no division by 0
      diagonal_[v] += stay_[v];
      if (fixed_[v]) right_[v] = glm::dvec3(0);
    }
  }

  /// By conjugate gradients (Hestenes and Stiefel 1952), preconditioned by the diagonal.
  Moves solve() const {
    const std::size_t count = right_.size();
    Moves x(count, glm::dvec3(0)), r = right_, z(count), q(count);
    for (std::size_t v = 0; v < count; ++v) z[v] = r[v] / diagonal_[v];
    Moves direction = z;
    double rz = dot(r, z);
    const double enough = kPrecision * kPrecision * rz;
    for (int step = 0; step < kMostSteps && rz > enough; ++step) {
      apply(direction, q);
      const double length = rz / dot(direction, q);
      for (std::size_t v = 0; v < count; ++v) {
        x[v] += length * direction[v];
        r[v] -= length * q[v];
        z[v] = r[v] / diagonal_[v];
      }
      const double next = dot(r, z);
      for (std::size_t v = 0; v < count; ++v) direction[v] = z[v] + next / rz * direction[v];
      rz = next;
    }
    return x;
  }

 private:
  /// area * (normal . (weighted move of the triangle's corners) - distance)^2
  struct Term {
    std::uint32_t triangle;
    double area;
    glm::dvec3 weights, normal;
  };

  static double dot(const Moves& a, const Moves& b) {
    double sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += glm::dot(a[v], b[v]);
    return sum;
  }

  void add(const FitPoint& p) {
    const Corners points = corners(mesh_, p.triangle);
    const TrianglePoint foot = closest_on_triangle(p.position, points);
    const Term term{p.triangle, p.area, foot.weights, unit_normal(points)};
    const double distance = glm::dot(p.position - foot.point, term.normal);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh_.triangles[p.triangle][i];
      const glm::dvec3 pull = term.area * term.weights[i] * term.normal;
      stay_[v] += term.area * term.weights[i];
      diagonal_[v] += pull * term.weights[i] * term.normal;
      right_[v] += distance * pull;
    }
    terms_.push_back(term);
  }

  void apply(const Moves& x, Moves& result) const {
    for (std::size_t v = 0; v < x.size(); ++v) result[v] = stay_[v] * x[v];
    for (const Term& term : terms_) {
      const auto& triangle = mesh_.triangles[term.triangle];
      double away = 0;
      for (int i = 0; i < 3; ++i) away += term.weights[i] * glm::dot(term.normal, x[triangle[i]]);
      for (int i = 0; i < 3; ++i)
        result[triangle[i]] += term.area * term.weights[i] * away * term.normal;
    }
    for (std::size_t v = 0; v < x.size(); ++v)
      if (fixed_[v]) result[v] = glm::dvec3(0);
  }

  const TriMesh& mesh_;
  const std::vector<std::uint8_t>& fixed_;
  std::vector<Term> terms_;
  std::vector<double> stay_;
  Moves diagonal_, right_;
};

}  // namespace

std::vector<glm::dvec3> fit_vertices(const std::vector<FitPoint>& points, const TriMesh& simple,
                                     const std::vector<std::uint8_t>& fixed, double most) {
  Moves moves = Problem(points, simple, fixed).solve();
  for (glm::dvec3& move : moves) {
    const double length = glm::length(move);
    if (length > most) move *= most / length;
  }
  return moves;
}

}  // namespace photohull
