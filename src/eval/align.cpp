// Based on: P. J. Besl, N. D. McKay, "A method for registration of 3-D shapes", 1992 [BeslMcKay92];
// D. Chetverikov et al., "The trimmed iterative closest point algorithm", 2002 [Chetverikov02];
// Y. Chen, G. Medioni, "Object modelling by registration of multiple range images", 1992
// [ChenMedioni92]; S. Umeyama, "Least-squares estimation of transformation parameters between two
// point patterns", 1991 [Umeyama91].
#include "eval/align.h"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <span>

#include "core/error.h"
#include "eval/nearest_sample.h"
#include "eval/surface_samples.h"
#include "eval/topology.h"
#include "raycast/closest_point.h"

namespace photohull::eval {
namespace {

using Points = std::vector<glm::dvec3>;

constexpr double kCounted = 0.8;  // of the pairs of either way
constexpr double kCell = 0.0005;  // of a cloud's diagonal: what points are thinned to
constexpr int kDrawnTurns = 24;
constexpr std::size_t kKept = 4;  // starts that are refined

/// How closely is looked: points of either side, steps at most, and the change of the rms to end
/// at.
struct Level {
  std::size_t points;
  int steps;
  double change;
};
constexpr Level kCoarse{600, 20, 1e-2}, kMiddle{4000, 60, 1e-3}, kFine{20000, 40, 1e-4};

double diagonal_of(const TriMesh& mesh) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::vec3& p : mesh.positions)
    low = glm::min(low, glm::dvec3(p)), high = glm::max(high, glm::dvec3(p));
  return glm::length(high - low);
}

/// Points in an order whose every beginning stands for all of them.
Points points_of(const TriMesh& mesh, std::uint64_t seed) {
  const double diagonal = diagonal_of(mesh);
  if (!(diagonal > 0 && std::isfinite(diagonal)))
    throw Error("what has no extent cannot be aligned; give a surface, or points of one");
  const TriMesh surface = without_degenerate_faces(mesh);
  Points points = surface.triangles.empty() ? thin_points(mesh, kCell * diagonal).points
                                            : sample_surface(surface, kFine.points, seed).points;
  std::mt19937_64 random(seed);
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random() % i]);
  if (points.size() > kFine.points) points.resize(kFine.points);
  return points;
}

std::span<const glm::dvec3> first(const Points& points, std::size_t count) {
  return {points.data(), std::min(points.size(), count)};
}

glm::dmat3 matrix_of(const Eigen::Matrix3d& m) {
  glm::dmat3 r;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 3; ++i) r[c][i] = m(i, c);
  return r;
}

struct Spread {
  glm::dvec3 middle{0.0};
  double size = 0;  ///< root mean square distance from it
  glm::dmat3 axes{1.0};
};

Spread spread_of(const Points& points) {
  Spread s;
  for (const glm::dvec3& p : points) s.middle += p / double(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const glm::dvec3& p : points) {
    const glm::dvec3 d = p - s.middle;
    const Eigen::Vector3d v(d.x, d.y, d.z);
    covariance += v * v.transpose() / double(points.size());
  }
  s.size = std::sqrt(covariance.trace());
  s.axes = matrix_of(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors());
  if (glm::determinant(s.axes) < 0) s.axes[0] = -s.axes[0];
  return s;
}

/// The 24 turns of a cube onto itself.
std::vector<glm::dmat3> cube_turns() {
  std::vector<glm::dmat3> turns;
  int order[3] = {0, 1, 2};
  do
    for (int signs = 0; signs < 8; ++signs) {
      glm::dmat3 r(0.0);
      for (int c = 0; c < 3; ++c) r[c][order[c]] = signs >> c & 1 ? -1 : 1;
      if (glm::determinant(r) > 0) turns.push_back(r);
    }
  while (std::next_permutation(order, order + 3));
  return turns;
}

/// Uniform over all turns: four normal numbers as a quaternion.
glm::dmat3 drawn_turn(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  double q[4];
  for (double& x : q) x = normal(random);
  return matrix_of(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix());
}

/// Of what has faces.
struct Surface {
  TriMesh mesh;  ///< without faces that have no area
  std::optional<ClosestPoint> nearest;

  explicit Surface(const TriMesh& whole) : mesh(without_degenerate_faces(whole)) {
    if (!mesh.triangles.empty()) nearest.emplace(mesh);
  }
};

class Aligner {
 public:
  Aligner(const TriMesh& result, const Truth& truth, std::uint64_t seed)
      : result_(points_of(result, seed)),
        truth_(points_of(truth.mesh(), seed + 1)),
        near_result_(result_),
        near_truth_(truth_),
        result_surface_(result),
        truth_surface_(truth.mesh()) {}

  Alignment run(std::uint64_t seed, Progress& progress) {
    std::vector<Alignment> found = starts(seed);
    for (std::size_t i = 0; i < found.size(); ++i) {
      progress.check_cancelled();
      progress.update(0.5 * double(i) / double(found.size()));
      iterate(kCoarse, false, progress, found[i]);
    }
    keep_best(kKept, found);
    for (Alignment& a : found) iterate(kMiddle, false, progress, a);
    keep_best(1, found);
    progress.update(0.7);
    iterate(kFine, true, progress, found[0]);
    const double trace =
        found[0].rotation[0][0] + found[0].rotation[1][1] + found[0].rotation[2][2];
    found[0].degrees = 57.29577951308232 * std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0));
    return found[0];
  }

 private:
  std::vector<Alignment> starts(std::uint64_t seed) const {
    const Spread from = spread_of(result_), to = spread_of(truth_);
    std::vector<Alignment> all = {Alignment{}};
    const auto add = [&](const glm::dmat3& turn) {
      Alignment a{to.size / from.size, turn};
      a.translation = to.middle - a.scale * (turn * from.middle);
      all.push_back(a);
    };
    add(glm::dmat3(1.0));
    for (const glm::dmat3& turn : cube_turns()) add(to.axes * turn * glm::transpose(from.axes));
    std::mt19937_64 random(seed);
    for (int i = 0; i < kDrawnTurns; ++i) add(drawn_turn(random));
    return all;
  }

  static void keep_best(std::size_t count, std::vector<Alignment>& found) {
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.rms < b.rms; });
    found.resize(std::min(count, found.size()));
  }

  struct Pair {
    glm::dvec3 from, to;     ///< of the result's world and of the truth's
    double distance = 0;     ///< truth's units
    glm::dvec3 normal{0.0};  ///< truth's world, where the nearest point is of a surface
  };

  struct Nearest {
    glm::dvec3 point, normal{0.0};
  };

  /// Of the surface, if that is asked for and there is one, else of the points.
  static Nearest nearest(const glm::dvec3& p, const NearestSample& near, const Points& points,
                         const Surface* surface) {
    if (!surface || !surface->nearest) return {points[near.find(p).index]};
    const NearestPoint found = surface->nearest->nearest(p);
    return {found.point, glm::normalize(area_vector(surface->mesh, found.triangle))};
  }

  /// Those that count, of both ways.
  std::vector<Pair> pairs(const Level& level, bool exact, const Alignment& a) const {
    const auto from = first(result_, level.points), to = first(truth_, level.points);
    std::vector<Pair> forth(from.size()), back(to.size());
    tbb::parallel_for(std::size_t(0), from.size(), [&](std::size_t i) {
      const glm::dvec3 p = a(from[i]);
      const Nearest q = nearest(p, near_truth_, truth_, exact ? &truth_surface_ : nullptr);
      forth[i] = {from[i], q.point, glm::distance(p, q.point), q.normal};
    });
    tbb::parallel_for(std::size_t(0), to.size(), [&](std::size_t i) {
      const glm::dvec3 p = glm::transpose(a.rotation) * (to[i] - a.translation) / a.scale;
      const Nearest q = nearest(p, near_result_, result_, exact ? &result_surface_ : nullptr);
      back[i] = {q.point, to[i], a.scale * glm::distance(p, q.point), a.rotation * q.normal};
    });
    std::vector<Pair> all;
    for (std::vector<Pair>* way : {&forth, &back}) {
      const auto end = way->begin() + long(std::ceil(kCounted * double(way->size())));
      std::nth_element(way->begin(), end - 1, way->end(),
                       [](const Pair& x, const Pair& y) { return x.distance < y.distance; });
      all.insert(all.end(), way->begin(), end);
    }
    return all;
  }

  static double rms_of(const std::vector<Pair>& pairs) {
    double sum = 0;
    for (const Pair& p : pairs) sum += p.distance * p.distance;
    return std::sqrt(sum / double(pairs.size()));
  }

  static Alignment fit(const std::vector<Pair>& pairs) {
    Eigen::Matrix3Xd x(3, pairs.size()), y(3, pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
      for (int k = 0; k < 3; ++k) x(k, long(i)) = pairs[i].from[k], y(k, long(i)) = pairs[i].to[k];
    const Eigen::Matrix4d m = Eigen::umeyama(x, y, true);
    Alignment a;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) a.rotation[c][r] = m(r, c);
      a.translation[c] = m(c, 3);
    }
    a.scale = std::cbrt(glm::determinant(a.rotation));
    a.rotation /= a.scale;
    return a;
  }

  /// One step of Gauss and Newton on the distances along the normals: a small turn, shift and
  /// change of scale after `a`. What the normals leave open stays as it is.
  static Alignment slide(const std::vector<Pair>& pairs, const Alignment& a) {
    constexpr double kHeld = 1e-9;  // of the normal matrix' trace
    glm::dvec3 middle(0.0);
    for (const Pair& p : pairs) middle += p.to / double(pairs.size());
    double size = 0;  // so that all unknowns are lengths
    for (const Pair& p : pairs) size += glm::distance(p.to, middle) / double(pairs.size());
    Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
    Eigen::Matrix<double, 7, 1> right = Eigen::Matrix<double, 7, 1>::Zero();
    for (const Pair& p : pairs) {
      const glm::dvec3 y = a(p.from), arm = (y - middle) / size, turned = glm::cross(arm, p.normal);
      Eigen::Matrix<double, 7, 1> row;
      row << turned.x, turned.y, turned.z, p.normal.x, p.normal.y, p.normal.z,
          glm::dot(arm, p.normal);
      normal += row * row.transpose();
      right += row * glm::dot(p.normal, p.to - y);
    }
    normal.diagonal().array() += kHeld * normal.trace();
    const Eigen::Matrix<double, 7, 1> x = normal.ldlt().solve(right);
    const Eigen::Vector3d turn = x.head<3>() / size;
    const glm::dmat3 r =
        turn.norm() > 0
            ? matrix_of(Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix())
            : glm::dmat3(1.0);
    const double scale = 1 + x[6] / size;
    Alignment next{a.scale * scale, r * a.rotation};
    next.translation =
        middle + scale * (r * (a.translation - middle)) + glm::dvec3(x[3], x[4], x[5]);
    return next;
  }

  void iterate(const Level& level, bool exact, Progress& progress, Alignment& a) const {
    std::vector<Pair> counted = pairs(level, exact, a);
    a.rms = rms_of(counted);
    for (int step = 0; step < level.steps; ++step) {
      progress.check_cancelled();
      const bool by_normals = exact && result_surface_.nearest && truth_surface_.nearest;
      Alignment next = by_normals ? slide(counted, a) : fit(counted);
      if (!(next.scale > 0 && std::isfinite(next.scale))) return;
      counted = pairs(level, exact, next);
      next.rms = rms_of(counted);
      const bool settled = a.rms - next.rms <= level.change * a.rms;
      if (next.rms <= a.rms) a = next;
      if (settled) return;
    }
  }

  Points result_, truth_;
  NearestSample near_result_, near_truth_;
  Surface result_surface_, truth_surface_;
};

}  // namespace

Alignment align(const TriMesh& result, const Truth& truth, std::uint64_t seed, Progress& progress) {
  return Aligner(result, truth, seed).run(seed, progress);
}

TriMesh moved(const TriMesh& mesh, const Alignment& alignment) {
  TriMesh out = mesh;
  out.origin = alignment(mesh.origin);
  for (glm::vec3& p : out.positions)
    p = glm::vec3(alignment.scale * (alignment.rotation * glm::dvec3(p)));
  for (glm::vec3& n : out.normals) n = glm::vec3(alignment.rotation * glm::dvec3(n));
  return out;
}

}  // namespace photohull::eval
