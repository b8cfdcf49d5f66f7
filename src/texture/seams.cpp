#include "texture/seams.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "texture/face_views.h"
#include "texture/surface.h"
#include "texture/view_maps.h"

namespace photohull::texture {
namespace {

constexpr int kMostSamples = 64;    // along a side
constexpr double kSmooth = 0.05;    // weight of equal levels along a side, beside seams' 1
constexpr double kAnchor = 1e-4;    // weight of no change
constexpr double kFullSamples = 2;  // that make half of a seam's weight

/// Colours along a seam on each of its sides, from its first end to its second.
struct SeamColours {
  std::array<std::vector<glm::vec3>, 2> roots;  // NaN where not clear
};

int samples_of(const Seam& seam, const TriMesh& mesh, const Planes& planes) {
  double length = 0;
  for (const std::uint32_t face : seam.faces) {
    Projected a, b;
    const Projector& projector = planes.projectors[planes.of_face[face]];
    if (projector.project(mesh.positions[seam.vertices[0]], a) &&
        projector.project(mesh.positions[seam.vertices[1]], b))
      length = std::max(length, glm::distance(glm::dvec2(a), glm::dvec2(b)));
  }
  return std::clamp(int(std::lround(length)) + 1, 2, kMostSamples);
}

/// The colour of a photograph at points of one of its triangles.
void sample_view(const TriMesh& mesh, const ViewPixels& pixels, const ViewMaps& maps,
                 const Projector& projector, const Seam& seam, std::vector<glm::vec3>& roots) {
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const float t = (float(i) + 0.5f) / float(roots.size());
    const glm::vec3 point =
        glm::mix(mesh.positions[seam.vertices[0]], mesh.positions[seam.vertices[1]], t);
    Projected p;
    if (!projector.project(point, p)) continue;
    const glm::dvec2 pixel = glm::round(glm::dvec2(p));
    if (!(std::abs(pixel.x) < 1e6 && std::abs(pixel.y) < 1e6)) continue;
    if (maps.clearance_of(int(pixel.x), int(pixel.y), p.z) < kLeastClearance) continue;
    roots[i] = pixels.root_between(glm::dvec2(p));
  }
}

std::vector<SeamColours> sample_seams(const TriMesh& mesh, std::span<const PreparedView> views,
                                      double scale, const Planes& planes,
                                      std::span<const Seam> seams, const FillColour& fill,
                                      Progress& progress) {
  std::vector<SeamColours> colours(seams.size());
  std::vector<std::vector<std::pair<std::size_t, int>>> of_plane(planes.projectors.size());
  for (std::size_t s = 0; s < seams.size(); ++s) {
    const int count = samples_of(seams[s], mesh, planes);
    for (int side = 0; side < 2; ++side) {
      colours[s].roots[side].assign(std::size_t(count), glm::vec3(NAN));
      of_plane[planes.of_face[seams[s].faces[side]]].emplace_back(s, side);
    }
  }
  for_views(of_plane.size(), [&](std::size_t p) {
    progress.check_cancelled();
    if (of_plane[p].empty()) return;
    if (p >= views.size()) {
      std::uint32_t hint = 0;
      for (const auto& [s, side] : of_plane[p])
        for (std::size_t i = 0; i < colours[s].roots[side].size(); ++i) {
          const double t = (double(i) + 0.5) / double(colours[s].roots[side].size());
          colours[s].roots[side][i] = fill.root(
              glm::mix(mesh.world(seams[s].vertices[0]), mesh.world(seams[s].vertices[1]), t),
              hint);
        }
      return;
    }
    const ViewPixels pixels(views[p], scale);
    const ViewMaps maps(mesh, pixels);
    for (const auto& [s, side] : of_plane[p])
      sample_view(mesh, pixels, maps, planes.projectors[p], seams[s], colours[s].roots[side]);
  });
  return colours;
}

/// The normal equations of the levels.
class Equations {
 public:
  explicit Equations(std::size_t unknowns)
      : right_(Eigen::MatrixX3d::Zero(Eigen::Index(unknowns), 3)) {
    for (std::size_t i = 0; i < unknowns; ++i) add(i, i, kAnchor);
  }

  /// weight * (x[a] - x[b] - difference)^2
  void equal(std::size_t a, std::size_t b, double weight, const glm::dvec3& difference) {
    add(a, a, weight);
    add(b, b, weight);
    add(a, b, -weight);
    add(b, a, -weight);
    for (int c = 0; c < 3; ++c) {
      right_(Eigen::Index(a), c) += weight * difference[c];
      right_(Eigen::Index(b), c) -= weight * difference[c];
    }
  }

  std::vector<glm::vec3> solve() const {
    const Eigen::Index n = right_.rows();
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success)
      throw Error("texture: the levels of its charts could not be solved for");
    const Eigen::MatrixX3d x = solver.solve(right_);
    std::vector<glm::vec3> out;
    for (Eigen::Index i = 0; i < n; ++i) out.emplace_back(x(i, 0), x(i, 1), x(i, 2));
    return out;
  }

 private:
  void add(std::size_t row, std::size_t column, double value) {
    entries_.emplace_back(Eigen::Index(row), Eigen::Index(column), value);
  }

  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::MatrixX3d right_;
};

/// What the second side has more than the first near each end of the seam.
void add_seam(const Seam& seam, const SeamColours& colours, const Planes& planes,
              const Levels& levels, Equations& equations) {
  for (int end = 0; end < 2; ++end) {
    glm::dvec3 sum(0);
    double weight = 0;
    const std::size_t count = colours.roots[0].size();
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3 difference = colours.roots[1][i] - colours.roots[0][i];
      if (!(difference.x == difference.x)) continue;
      const double t = (double(i) + 0.5) / double(count), w = end == 0 ? 1 - t : t;
      sum += w * difference;
      weight += w;
    }
    if (weight == 0) continue;
    const std::uint32_t vertex = seam.vertices[end];
    equations.equal(levels.index(vertex, planes.of_face[seam.faces[0]]),
                    levels.index(vertex, planes.of_face[seam.faces[1]]),
                    weight / (weight + kFullSamples), sum / weight);
  }
}

}  // namespace

std::vector<Seam> find_seams(const TriMesh& mesh,
                             const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                             const std::vector<std::uint32_t>& plane_of_face) {
  std::vector<Seam> seams;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = neighbours[f][i];
      if (other == kNoFace || other < f || plane_of_face[other] == plane_of_face[f]) continue;
      seams.push_back({{f, other}, {mesh.triangles[f][i], mesh.triangles[f][(i + 1) % 3]}});
    }
  return seams;
}

Levels::Levels(const TriMesh& mesh, const std::vector<std::uint32_t>& plane_of_face) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const std::uint32_t vertex : mesh.triangles[f])
      pairs.emplace_back(vertex, plane_of_face[f]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  first_.assign(mesh.positions.size() + 1, 0);
  for (const auto& [vertex, plane] : pairs) {
    ++first_[vertex + 1];
    planes_.push_back(plane);
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  values_.assign(planes_.size(), glm::vec3(0));
}

std::size_t Levels::index(std::uint32_t vertex, std::uint32_t plane) const {
  const auto begin = planes_.begin();
  const auto found = std::lower_bound(begin + std::ptrdiff_t(first_[vertex]),
                                      begin + std::ptrdiff_t(first_[vertex + 1]), plane);
  return std::size_t(found - begin);
}

Levels level_seams(const TriMesh& mesh, std::span<const PreparedView> views, double scale,
                   const Planes& planes, std::span<const Seam> seams, const FillColour& fill,
                   Progress& progress) {
  Levels levels(mesh, planes.of_face);
  if (seams.empty()) return levels;
  const std::vector<SeamColours> colours =
      sample_seams(mesh, views, scale, planes, seams, fill, progress);
  Equations equations(levels.size());
  for (std::size_t s = 0; s < seams.size(); ++s)
    add_seam(seams[s], colours[s], planes, levels, equations);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangles[f][i], b = mesh.triangles[f][(i + 1) % 3];
      equations.equal(levels.index(a, planes.of_face[f]), levels.index(b, planes.of_face[f]),
                      kSmooth, glm::dvec3(0));
    }
  progress.check_cancelled();
  levels.set(equations.solve());
  return levels;
}

}  // namespace photohull::texture
