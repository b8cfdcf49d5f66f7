// What fits of patches start from, and what is made of them [Goesele07; Furukawa10].
#include "refine/fit_patches.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "projtex/photographs.h"

namespace photohull::refine {
namespace {

constexpr int kSmoothings = 2;  // of the curvature over neighbours

template <typename F>
void for_vertices(std::size_t count, F&& f) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 2048), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) f(i);
  });
}

/// Least squares for the symmetric map from steps in the tangent plane to changes of the normal.
glm::dmat3 curvature_tensor(const VertexGraph& graph, std::span<const glm::vec3> positions,
                            std::span<const glm::vec3> normals, std::size_t i) {
  const glm::dvec3 n(normals[i]);
  const auto [u, v] = tangent_axes(n);
  double ss = 1e-3, st = 0, tt = 1e-3;
  glm::dvec3 right(0);  // for uu, uv, vv
  for (const std::uint32_t j : graph.of(i)) {
    const glm::dvec3 step(positions[j] - positions[i]), other(normals[j]);
    const double facing = glm::dot(other, n);
    if (facing < 0.3) continue;
    const double s = glm::dot(step, u), t = glm::dot(step, v);
    const double a = -glm::dot(other, u) / facing, b = -glm::dot(other, v) / facing;
    ss += s * s, st += s * t, tt += t * t;
    right += glm::dvec3(s * a, t * a + s * b, t * b);
  }
  const glm::dmat3 normal_equations(ss, st, 0, st, ss + tt, st, 0, st, tt);
  const glm::dvec3 k = glm::inverse(normal_equations) * right;
  return k.x * glm::outerProduct(u, u) + k.z * glm::outerProduct(v, v) +
         k.y * (glm::outerProduct(u, v) + glm::outerProduct(v, u));
}

/// A symmetric matrix of floats: diagonal, and xy, xz, yz.
struct Symmetric {
  glm::vec3 diagonal{0}, beside{0};

  Symmetric() = default;
  explicit Symmetric(const glm::dmat3& m)
      : diagonal(m[0][0], m[1][1], m[2][2]), beside(m[0][1], m[0][2], m[1][2]) {}
  void operator+=(const Symmetric& o) { diagonal += o.diagonal, beside += o.beside; }
  void operator/=(float divisor) { diagonal /= divisor, beside /= divisor; }
  glm::dmat3 whole() const {
    const glm::dvec3 d(diagonal), b(beside);
    return {d.x, b.x, b.y, b.x, d.y, b.z, b.y, b.z, d.z};
  }
};

}  // namespace

bool holds_out(const glm::vec3& position, int one_in) {
  if (one_in <= 0) return false;
  std::uint32_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ std::uint32_t(int(std::floor(position[axis])))) * 2654435761u;
    hash ^= hash >> 15;
  }
  return hash % std::uint32_t(one_in) == 0;
}

TangentAxes tangent_axes(const glm::dvec3& normal) {
  const glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(helper, normal));
  return {u, glm::cross(normal, u)};
}

std::vector<glm::vec3> curvatures(const VertexGraph& graph, std::span<const glm::vec3> positions,
                                  std::span<const glm::vec3> normals, double most) {
  const std::size_t n = graph.vertices();
  std::vector<Symmetric> tensor(n), next(n);
  for_vertices(n, [&](std::size_t i) {
    tensor[i] = Symmetric(curvature_tensor(graph, positions, normals, i));
  });
  for (int pass = 0; pass < kSmoothings; ++pass) {
    for_vertices(n, [&](std::size_t i) {
      next[i] = tensor[i];
      float total = 1;
      for (const std::uint32_t j : graph.of(i)) {
        if (glm::dot(normals[i], normals[j]) < 0.3f) continue;
        next[i] += tensor[j];
        total += 1;
      }
      next[i] /= total;
    });
    tensor.swap(next);
  }
  std::vector<glm::vec3> out(n);
  for_vertices(n, [&](std::size_t i) {
    const auto [u, v] = tangent_axes(glm::dvec3(normals[i]));
    const glm::dmat3 k = tensor[i].whole();
    const glm::dvec3 c(glm::dot(u, k * u), glm::dot(u, k * v), glm::dot(v, k * v));
    const double size = std::sqrt(c.x * c.x + 2 * c.y * c.y + c.z * c.z);
    if (std::isfinite(size)) out[i] = glm::vec3(c * std::min(1.0, most / std::max(size, 1e-9)));
  });
  return out;
}

std::vector<float> tap_spacings(const GridSpec& grid, std::span<const glm::vec3> positions,
                                std::span<const Camera> cameras,
                                std::span<const ViewChoice> choices, const FitOptions& options) {
  const std::vector<projtex::GridCamera> views = projtex::to_grid(cameras, grid);
  std::vector<float> out(positions.size(), float(options.least_spacing));
  for_vertices(out.size(), [&](std::size_t i) {
    if (choices[i].views.empty()) return;
    const projtex::GridCamera& view = views[std::size_t(choices[i].reference())];
    const double pixel = glm::distance(view.centre, glm::dvec3(positions[i])) / view.focal;
    out[i] = float(std::max(options.least_spacing, options.pixel_spacing * pixel));
  });
  return out;
}

std::vector<Peak> peaks_of(std::span<const PatchFit> results, std::span<const float> spacings,
                           const FitOptions& options) {
  std::vector<Peak> peaks(results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const PatchFit& r = results[i];
    if (std::abs(r.offset) >= options.largest_offset) continue;  // it wanted to go farther
    const double agreement = std::clamp(
        (r.score - options.least_score) / (options.full_score - options.least_score), 0.0, 1.0);
    const double weight =
        agreement * std::min(r.information * options.unit_deviation * options.unit_deviation,
                             options.most_weight);
    if (!(weight > 0)) continue;
    const double square = double(spacings[i]) * spacings[i];
    peaks[i] = {r.offset, float(weight / (square * square)), r.score};
  }
  return peaks;
}

std::int64_t samples_of(std::span<const ViewChoice> choices, const FitOptions& options) {
  std::int64_t views = 0;
  for (const ViewChoice& choice : choices)
    if (choice.comparable()) views += choice.views.size();
  return views * 2 * kPatchTaps * (options.steps + 1);
}

HeldOut held_out(std::span<const PatchFit> results) {
  HeldOut out;
  for (const PatchFit& r : results) {
    if (r.held_before == kNoScore || r.held_after == kNoScore) continue;
    out.before += r.held_before, out.after += r.held_after;
    ++out.surfels;
  }
  if (out.surfels) out.before /= double(out.surfels), out.after /= double(out.surfels);
  return out;
}

}  // namespace photohull::refine
