#include "carving/fit_stems.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

namespace photohull::carving {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kNear = 1.5;         // pixels from a vertex to a line that it belongs to, and
constexpr double kNearVoxels = 1.25;  // voxels
constexpr int kIterations = 4;
constexpr double kRobust = 0.75;        // pixels: residuals beyond lose their weight
constexpr double kSheet = 0.04;         // of the largest eigenvalue: a direction that is not known
constexpr double kStraight = 0.3;       // of the second one: lines that do not belong together
constexpr double kDamping = 0.01;       // of the largest eigenvalue
constexpr double kForeshortened = 0.3;  // least length of a line's direction in a picture
constexpr double kProfile = 4;          // pixels across a line, to either side
constexpr double kStep = 0.5;
constexpr double kOff = 1.5;           // pixels by which a view may see the line elsewhere
constexpr double kLeastRadius = 0.05;  // pixels
constexpr int kSmoothing = 4;          // passes over neighbours

/// A view's lines, to be found by their place.
class LineIndex {
 public:
  explicit LineIndex(const StemView& view)
      : view_(view),
        hard_(std::all_of(view.mask->coverage.begin(), view.mask->coverage.end(),
                          [](std::uint8_t c) { return c == 0 || c == 255; })),
        projection_(view.camera.projection()) {
    first_.assign(std::size_t(view.mask->height) + 2, 0);
    for (const LinePoint& p : *view.lines) ++first_[row_of(p) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    order_.resize(view.lines->size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[next[row_of((*view.lines)[i])]++] = i;
    for (std::size_t row = 0; row + 1 < first_.size(); ++row)
      std::sort(order_.begin() + first_[row], order_.begin() + first_[row + 1],
                [&](std::uint32_t a, std::uint32_t b) {
                  return (*view.lines)[a].x < (*view.lines)[b].x;
                });
  }

  const StemView& view() const { return view_; }

  /// Pixel and depth of a point on the image.
  bool project(const dvec3& p, dvec2& pixel, double& depth) const {
    const dvec3 q = projection_ * glm::dvec4(p, 1);
    if (!(q.z > 0)) return false;
    pixel = dvec2(q.x / q.z, q.y / q.z), depth = q.z;
    return view_.camera.on_image(pixel);
  }

  /// World gradient of the pixel position along a direction of the picture.
  dvec3 gradient(const dvec2& pixel, double depth, const dvec2& along) const {
    dvec3 g(0);
    for (int axis = 0; axis < 3; ++axis) {
      const dvec3 column = projection_[axis];
      g[axis] =
          along.x * (column.x - pixel.x * column.z) + along.y * (column.y - pixel.y * column.z);
    }
    return g / depth;
  }

  const LinePoint* nearest(const dvec2& pixel, double within) const {
    const LinePoint* best = nullptr;
    double distance = within * within;
    const int low = std::max(int(std::floor(pixel.y - within)), 0);
    const int high = std::min(int(std::ceil(pixel.y + within)), view_.mask->height - 1);
    for (int y = low; y <= high; ++y) {
      auto from = order_.begin() + first_[std::size_t(y)];
      const auto end = order_.begin() + first_[std::size_t(y) + 1];
      from = std::lower_bound(from, end, pixel.x - within - 1,
                              [&](std::uint32_t i, double x) { return (*view_.lines)[i].x < x; });
      for (; from != end; ++from) {
        const LinePoint& p = (*view_.lines)[*from];
        if (p.x > pixel.x + within + 1) break;
        const double d = (p.x - pixel.x) * (p.x - pixel.x) + (p.y - pixel.y) * (p.y - pixel.y);
        if (d < distance) distance = d, best = &p;
      }
    }
    return best;
  }

  /// Integral of the coverage across a line through the pixel; nothing where something else stands
  /// beside it, or where a mask that could show a share of a pixel shows none.
  std::optional<double> width(const dvec2& pixel, const dvec2& across) const {
    const auto at = [&](double s) { return coverage(pixel + s * across); };
    double middle = 0, where = 0;
    for (double s = -kOff; s <= kOff; s += kStep)
      if (const double c = at(s); c > middle) middle = c, where = s;
    if (middle == 0) return hard_ ? std::optional(0.0) : std::nullopt;
    double sum = kStep * middle;
    for (const double sign : {-1.0, 1.0}) {
      double before = middle;
      for (double s = kStep; s <= kProfile; s += kStep) {
        const double c = at(where + sign * s);
        if (c > before && before < 0.5 * middle) return std::nullopt;
        sum += kStep * c;
        before = c;
        if (c == 0) break;
      }
      if (before > 0) return std::nullopt;
    }
    return sum;
  }

 private:
  std::size_t row_of(const LinePoint& p) const {
    return std::size_t(std::clamp(int(std::lround(p.y)), 0, view_.mask->height - 1));
  }
  double coverage(const dvec2& p) const {
    const Mask& m = *view_.mask;
    const int x = int(std::floor(p.x)), y = int(std::floor(p.y));
    const auto at = [&](int i, int j) {
      return double(m.coverage[std::size_t(std::clamp(j, 0, m.height - 1)) * std::size_t(m.width) +
                               std::size_t(std::clamp(i, 0, m.width - 1))]);
    };
    const double u = p.x - x, v = p.y - y;
    return ((1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) +
            v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1))) /
           255.0;
  }

  StemView view_;
  bool hard_;  ///< a pixel is the object's or not: a thin line comes and goes
  glm::dmat4x3 projection_;
  std::vector<std::uint32_t> first_, order_;
};

/// What the lines say of the part around a vertex. World units.
struct Stem {
  dvec3 centre{0.0};  ///< on its middle line or sheet, beside the vertex
  dvec3 axis{0.0};    ///< unit, along a stem; 0: a sheet
  dvec3 across{0.0};  ///< unit, across a sheet
  double radius = 0;  ///< half of the thickness; 0: nothing is known
};

class Fitter {
 public:
  Fitter(std::span<const StemView> views, double voxel_size, const StemOptions& options)
      : voxel_size_(voxel_size), options_(options) {
    for (const StemView& view : views)
      if (view.mask && view.lines) views_.emplace_back(view);
    // So that a vertex beside no line costs a look at the views that have any.
    std::stable_partition(views_.begin(), views_.end(),
                          [](const LineIndex& v) { return !v.view().lines->empty(); });
  }

  Stem fit(const dvec3& vertex) const {
    Stem stem;
    dvec3 centre = vertex;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    for (int i = 0; i < kIterations; ++i) {
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      int seen = 0, shown = 0;
      for (const LineIndex& view : views_) {
        if (view.view().lines->empty() && shown < options_.least_views) return stem;
        dvec2 pixel;
        double depth;
        if (!view.project(centre, pixel, depth)) continue;
        ++seen;
        const double voxel = voxel_size_ * view.view().camera.intrinsics.fx / depth;  // pixels
        const LinePoint* line = view.nearest(pixel, kNear + (i < 2 ? kNearVoxels * voxel : 0));
        if (!line) continue;
        ++shown;
        const dvec2 across(line->normal_x, line->normal_y);
        const double off = glm::dot(across, pixel - dvec2(line->x, line->y));
        const double robust = kRobust + (i < 2 ? voxel : 0);
        const double weight =
            1 / ((1 + off * off / (robust * robust)) * (1 + off * off / (robust * robust)));
        const dvec3 g = view.gradient(pixel, depth, across);
        const Eigen::Vector3d row(g.x, g.y, g.z);
        normal += weight * row * row.transpose();
        right += weight * off * row;
      }
      if (shown < options_.least_views || shown < options_.least_share * seen) return stem;
      solver.computeDirect(normal);
      const auto values = solver.eigenvalues();
      const int known = values[1] < kSheet * values[2] ? 1 : 2;
      if (known == 2 && values[0] > kStraight * values[1]) return stem;
      Eigen::Vector3d step = Eigen::Vector3d::Zero();
      for (int k = 3 - known; k < 3; ++k) {
        const Eigen::Vector3d v = solver.eigenvectors().col(k);
        step -= v * (v.dot(right) / (values[k] + kDamping * values[2]));
      }
      centre += dvec3(step[0], step[1], step[2]);
      const auto direction = [&](int k) {
        const auto v = solver.eigenvectors().col(k);
        return dvec3(v[0], v[1], v[2]);
      };
      stem.axis = known == 2 ? direction(0) : dvec3(0);
      stem.across = known == 1 ? direction(2) : dvec3(0);
    }
    stem.centre = centre;
    stem.radius = radius(stem);
    return stem;
  }

 private:
  double radius(const Stem& stem) const {
    double sum = 0, pixel_size = 0;
    int count = 0;
    for (const LineIndex& view : views_) {
      dvec2 pixel;
      double depth;
      if (!view.project(stem.centre, pixel, depth)) continue;
      const double scale = depth / view.view().camera.intrinsics.fx;
      const dvec3 gx = view.gradient(pixel, depth, {1, 0}),
                  gy = view.gradient(pixel, depth, {0, 1});
      const bool sheet = stem.axis == dvec3(0);
      const dvec3 direction = sheet ? stem.across : stem.axis;
      const dvec2 seen(glm::dot(gx, direction), glm::dot(gy, direction));
      const double length = glm::length(seen) * scale;
      if (length < kForeshortened) continue;
      const dvec2 along = seen / glm::length(seen);
      // A sheet that is seen at a slant shows more than its edge.
      const dvec2 across = sheet ? along : dvec2(-along.y, along.x);
      const auto width = view.width(pixel, across);
      if (!width) continue;
      sum += *width * scale, pixel_size += scale, ++count;
    }
    if (count < options_.least_views) return 0;
    return std::max(0.5 * sum / count, kLeastRadius * pixel_size / count);
  }

  double voxel_size_;
  StemOptions options_;
  std::vector<LineIndex> views_;
};

/// Neighbours agree: middles move across their stems toward the mean of those around, radii too.
void smooth(const TriMesh& mesh, std::vector<Stem>& stems) {
  struct Sum {
    dvec3 centre{0.0};
    double radius = 0, count = 0;
  };
  for (int pass = 0; pass < kSmoothing; ++pass) {
    std::vector<Sum> sums(stems.size());
    for (const auto& t : mesh.triangles)
      for (int i = 0; i < 3; ++i)
        for (int j = 1; j < 3; ++j) {
          const Stem& other = stems[t[std::size_t((i + j) % 3)]];
          if (other.radius == 0) continue;
          Sum& sum = sums[t[std::size_t(i)]];
          sum.centre += other.centre, sum.radius += other.radius, sum.count += 1;
        }
    for (std::size_t i = 0; i < stems.size(); ++i) {
      Stem& s = stems[i];
      if (s.radius == 0 || sums[i].count == 0) continue;
      dvec3 to_mean = sums[i].centre / sums[i].count - s.centre;
      if (s.axis != dvec3(0))
        to_mean -= glm::dot(to_mean, s.axis) * s.axis;
      else
        to_mean = glm::dot(to_mean, s.across) * s.across;
      s.centre += 0.5 * to_mean;
      s.radius = 0.5 * (s.radius + sums[i].radius / sums[i].count);
    }
  }
}

/// Where the vertex belongs.
dvec3 placed(const Stem& stem, const dvec3& vertex, const dvec3& normal) {
  const dvec3 off = vertex - stem.centre;
  if (stem.axis == dvec3(0)) {
    const double side = glm::dot(normal, stem.across) >= 0 ? 1 : -1;
    return vertex + (side * stem.radius - glm::dot(off, stem.across)) * stem.across;
  }
  const auto across = [&](const dvec3& v) { return v - glm::dot(v, stem.axis) * stem.axis; };
  dvec3 out = across(off);
  if (glm::length(out) < 0.5 * stem.radius) out = across(normal);
  const double length = glm::length(out);
  if (!(length > 0)) return vertex;
  return stem.centre + glm::dot(off, stem.axis) * stem.axis + stem.radius / length * out;
}

}  // namespace

std::size_t fit_stems(std::span<const StemView> views, double voxel_size, TriMesh& mesh,
                      const StemOptions& options) {
  if (std::none_of(views.begin(), views.end(),
                   [](const StemView& v) { return v.lines && !v.lines->empty(); }))
    return 0;
  const Fitter fitter(views, voxel_size, options);
  std::vector<Stem> stems(mesh.positions.size());
  tbb::parallel_for(std::size_t(0), stems.size(),
                    [&](std::size_t i) { stems[i] = fitter.fit(mesh.world(i)); });
  smooth(mesh, stems);
  const double farthest = (kNearVoxels + 1) * voxel_size;
  std::size_t moved = 0;
  for (std::size_t i = 0; i < stems.size(); ++i) {
    if (stems[i].radius == 0) continue;
    const dvec3 vertex = mesh.world(i), to = placed(stems[i], vertex, dvec3(mesh.normals[i]));
    if (!(glm::distance(vertex, to) < farthest)) continue;
    mesh.positions[i] = glm::vec3(to - mesh.origin);
    ++moved;
  }
  return moved;
}

}  // namespace photohull::carving
