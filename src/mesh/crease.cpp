// Hermite data for the creases [Kobbelt01; Ju02], from flanks that are fitted beside them: nearer
// by, positions and normals are rounded off.
#include "mesh/crease.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace photohull {
namespace {

using glm::dvec3;
using Index = std::uint32_t;

constexpr std::size_t kLeastSupport = 10;  // vertices of a flank
constexpr double kNear = 4;                // lengths: standard deviation of the vertices' weights
constexpr double kNoise = 0.02;            // lengths: least standard deviation of their places
/// Flanks are nearly plane: standard deviation of their curvature in a fit, 1 / length, where so
/// many vertices err alike. Smoothing rings beside creases, and curvature would follow that.
constexpr double kCurvature = 0.007, kAlike = 5;
constexpr double kRoughness = 0.01;      // radians: least of a flank
constexpr double kMostTurn = 120;        // degrees between flanks
constexpr double kSlack = 0.1;           // lengths, of the distance from the flanks
constexpr double kCornerRounding = 1.5;  // corners are farther from their flanks than edges

constexpr double kLeastSine = 0.1;  // between flanks that are intersected

using Matrix = std::array<std::array<double, 6>, 6>;

/// Cholesky's method; a is symmetric, its lower half given.
bool solve(Matrix& a, std::array<double, 6>& b) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i == j && !(sum > 1e-12)) return false;
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (int i = 5; i >= 0; --i) {
    for (int k = i + 1; k < 6; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return true;
}

double nearness(const dvec3& d) { return std::exp(-glm::dot(d, d) / (2 * kNear * kNear)); }

/// Vertices within reach of `centre`, along the mesh; their part is 0, or -1 of rounded ones.
void gather(const CreaseMesh& mesh, Index centre, double reach, CreaseScratch& s) {
  if (s.visit.size() != mesh.positions.size()) {
    s.visit.assign(mesh.positions.size(), ~Index(0));
    s.part.resize(mesh.positions.size());
  }
  s.ball.assign(1, centre);
  s.visit[centre] = centre;
  s.part[centre] = -1;
  for (std::size_t k = 0; k < s.ball.size(); ++k)
    for (const Index face : mesh.around(s.ball[k]))
      for (const Index j : mesh.triangles[face]) {
        if (s.visit[j] == centre) continue;
        const dvec3 d = mesh.positions[j] - mesh.positions[centre];
        if (glm::dot(d, d) > reach * reach) continue;
        s.visit[j] = centre;
        s.part[j] = mesh.rounded[j] ? -1 : 0;
        s.ball.push_back(j);
      }
}

/// The connected parts of what gather left, as s.support; how many, or 0 of more than three.
int divide(const CreaseMesh& mesh, Index centre, CreaseScratch& s) {
  int parts = 0;
  std::vector<Index> part;
  for (const Index start : s.ball) {
    if (s.part[start] != 0) continue;
    s.part[start] = 1;
    part.assign(1, start);
    for (std::size_t k = 0; k < part.size(); ++k)
      for (const Index face : mesh.around(part[k]))
        for (const Index j : mesh.triangles[face])
          if (s.visit[j] == centre && s.part[j] == 0) {
            s.part[j] = 1;
            part.push_back(j);
          }
    if (part.size() < kLeastSupport) continue;
    if (parts == 3) return 0;
    s.support[parts++].swap(part);
  }
  return parts;
}

double distance_to(const CreaseMesh& mesh, Index centre, std::span<const Index> vertices,
                   const dvec3& point) {
  double least = std::numeric_limits<double>::max();
  for (const Index j : vertices) {
    const dvec3 d = mesh.positions[j] - mesh.positions[centre] - point;
    least = std::min(least, glm::dot(d, d));
  }
  return std::sqrt(least);
}

/// The shortest step from a point onto the tangent planes of one to three flanks.
dvec3 step_to(std::span<const Flank* const> flanks, const dvec3& at) {
  std::array<dvec3, 3> n{};
  dvec3 d(0);
  for (std::size_t k = 0; k < flanks.size(); ++k)
    n[k] = flanks[k]->normal(at), d[int(k)] = -flanks[k]->distance(at);
  if (flanks.size() == 1) return d.x * n[0];
  if (flanks.size() == 2) {
    const double g = glm::dot(n[0], n[1]), sine = 1 - g * g;
    if (sine < kLeastSine * kLeastSine) return dvec3(0);
    return ((d.x - g * d.y) * n[0] + (d.y - g * d.x) * n[1]) / sine;
  }
  const glm::dmat3 planes = glm::transpose(glm::dmat3(n[0], n[1], n[2]));
  if (flanks.size() != 3 || std::abs(glm::determinant(planes)) < kLeastSine) return dvec3(0);
  return glm::inverse(planes) * d;
}

}  // namespace

dvec3 meeting_point(std::span<const Flank* const> flanks, dvec3 point) {
  for (int step = 0; step < 2; ++step) point += step_to(flanks, point);
  return point;
}

double Flank::height(double x, double y) const {
  return c_[0] + c_[1] * x + c_[2] * y + 0.5 * (c_[3] * x * x + 2 * c_[4] * x * y + c_[5] * y * y);
}

double Flank::distance(const dvec3& p) const {
  return (glm::dot(p, n_) - height(glm::dot(p, u_), glm::dot(p, v_))) /
         std::sqrt(1 + c_[1] * c_[1] + c_[2] * c_[2]);
}

dvec3 Flank::normal(const dvec3& p) const {
  const double x = glm::dot(p, u_), y = glm::dot(p, v_);
  return glm::normalize(n_ - (c_[1] + c_[3] * x + c_[4] * y) * u_ -
                        (c_[2] + c_[4] * x + c_[5] * y) * v_);
}

bool Flank::fit(const CreaseMesh& mesh, Index centre, std::span<const Index> support) {
  dvec3 sum(0);
  for (const Index j : support) sum += dvec3(mesh.normals[j]);
  if (!(glm::length(sum) > 0.5 * double(support.size()))) return false;
  n_ = glm::normalize(sum);
  u_ = glm::normalize(glm::cross(std::abs(n_.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), n_));
  v_ = glm::cross(n_, u_);
  double variance = 4 * kNoise * kNoise;
  for (int pass = 0; pass < 2; ++pass) {  // the second gives less weight to what the first misses
    Matrix a{};
    std::array<double, 6> b{};
    for (const Index j : support) {
      const dvec3 d = mesh.positions[j] - mesh.positions[centre];
      const double x = glm::dot(d, u_), y = glm::dot(d, v_), h = glm::dot(d, n_);
      const double off = pass ? h - height(x, y) : 0, robust = 1 + off * off / (4 * variance);
      const double weight = nearness(d) / (robust * robust);
      const std::array<double, 6> g{1, x, y, 0.5 * x * x, x * y, 0.5 * y * y};
      for (int r = 0; r < 6; ++r) {
        for (int c = 0; c <= r; ++c) a[r][c] += weight * g[r] * g[c];
        b[r] += weight * g[r] * h;
      }
    }
    for (int r = 3; r < 6; ++r) a[r][r] += kAlike * variance / (kCurvature * kCurvature);
    if (!solve(a, b)) return false;
    c_ = b;
    double squares = 0, angles = 0, total = 0;
    for (const Index j : support) {
      const dvec3 d = mesh.positions[j] - mesh.positions[centre];
      const double off = glm::dot(d, n_) - height(glm::dot(d, u_), glm::dot(d, v_));
      const dvec3 turn = normal(d) - dvec3(mesh.normals[j]);
      const double weight = nearness(d);
      squares += weight * off * off;
      angles += weight * glm::dot(turn, turn);
      total += weight;
    }
    variance = std::max(squares / total, kNoise * kNoise);
    roughness_ = std::sqrt(angles / total);
  }
  return true;
}

Crease find_crease(const CreaseMesh& mesh, Index centre, const SharpenOptions& options,
                   CreaseScratch& scratch) {
  Crease out;
  gather(mesh, centre, options.reach, scratch);
  const int parts = divide(mesh, centre, scratch);
  if (parts < 2) return out;
  for (int k = 0; k < parts; ++k)
    if (!out.flank[k].fit(mesh, centre, scratch.support[k])) return out;

  double most = -1, least = 1, roughness = kRoughness;  // most, least: cosines between flanks
  for (int k = 0; k < parts; ++k) {
    roughness = std::max(roughness, out.flank[k].roughness());
    for (int l = 0; l < k; ++l) {
      const double c = glm::dot(out.flank[k].normal(dvec3(0)), out.flank[l].normal(dvec3(0)));
      most = std::max(most, c), least = std::min(least, c);
    }
  }
  out.finding = Crease::Finding::kNone;
  if (least < std::cos(glm::radians(kMostTurn))) return out;
  out.flanks = parts;
  std::array<const Flank*, 3> flanks{};
  for (int k = 0; k < parts; ++k) flanks[k] = &out.flank[k];
  const dvec3 line = meeting_point(std::span(flanks.data(), std::size_t(parts)), dvec3(0));
  // An edge rounded by a radius r lies r (1 / cos(turn / 2) - 1) off the line of its flanks.
  const double round = options.rounding * (parts == 3 ? kCornerRounding : 1);
  if (std::acos(std::clamp(most, -1.0, 1.0)) >= options.distinct * roughness &&
      distance_to(mesh, centre, scratch.ball, line) <=
          round * (1 / std::sqrt(0.5 * (1 + least)) - 1) + kSlack)
    out.finding = Crease::Finding::kFound;
  return out;
}

}  // namespace photohull
