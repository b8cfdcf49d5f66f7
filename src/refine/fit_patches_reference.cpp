#include "refine/fit_patches_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace photohull::refine::reference {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

constexpr int kRadius = kPatchRadius;
constexpr int kValues = 3 * kPatchTaps;

/// Variance of a derivative over that of a value where both are noise, texels.
constexpr double kDerivativeNoise = 2.4;

using Values = std::array<double, kValues>;

double dot(const Values& a, const Values& b) {
  double sum = 0;
  for (int k = 0; k < kValues; ++k) sum += a[k] * b[k];
  return sum;
}

void add(double factor, const Values& from, Values& to) {
  for (int k = 0; k < kValues; ++k) to[k] += factor * from[k];
}

/// Takes each channel's mean away.
void centre(Values& x) {
  for (int c = 0; c < 3; ++c) {
    double mean = 0;
    for (int k = c; k < kValues; k += 3) mean += x[k] / kPatchTaps;
    for (int k = c; k < kValues; k += 3) x[k] -= mean;
  }
}

/// One view's patch, normalised, and its derivatives by offset and slopes.
struct Sight {
  bool before_camera = false;
  double texels_per_voxel = 0;
  Values x{};
  std::array<Values, 3> by{};
};

struct Model {
  dvec3 gradient{0.0};
  dmat3 hessian{0.0};
  double score = kNoScore, held = kNoScore, variance = 0, noise = 0;
};

struct Frame {
  dvec3 position, normal, u, v;
  double spacing;
  dvec3 curvature;
};

/// `noise`: variance of the samples that is noise.
Sight look(const MatchView& view, const Frame& frame, const dvec3& theta, double noise) {
  Sight out;
  const dvec3 at = frame.position + theta.x * frame.normal;
  const dvec3 p = view.camera.projection * glm::dvec4(at, 1);
  out.before_camera = p.z > 1;
  if (!out.before_camera) return out;
  const dvec2 pixel = dvec2(p) / p.z;
  const dvec2 du = derivative(view.camera, at, frame.u);
  const dvec2 dv = derivative(view.camera, at, frame.v);
  const dvec2 dn = derivative(view.camera, at, frame.normal);
  const double area = std::abs(du.x * dv.y - du.y * dv.x);
  const int level = area > 1 ? int(std::floor(std::log2(std::sqrt(area)) + 0.5)) : 0;
  const double speed = glm::length(dn), texel = std::exp2(level);
  const dvec2 aside = 0.5 * texel / std::max(speed, 1e-6) * dn;
  out.texels_per_voxel = speed / texel;
  Values slope{};
  int k = 0;
  for (int j = -kRadius; j <= kRadius; ++j)
    for (int i = -kRadius; i <= kRadius; ++i) {
      if ((i + j) % 2 != 0) continue;
      const double s = i * frame.spacing, t = j * frame.spacing;
      const double height = 0.5 * (frame.curvature.x * s * s + 2 * frame.curvature.y * s * t +
                                   frame.curvature.z * t * t);
      const dvec2 place =
          pixel + double(i) * du + double(j) * dv + (theta.y * i + theta.z * j + height) * dn;
      const dvec3 a = sample(view, place - aside, level), b = sample(view, place + aside, level);
      for (int c = 0; c < 3; ++c, ++k) {
        out.x[k] = 0.5 * (a[c] + b[c]);
        slope[k] = (b[c] - a[c]) / texel * speed;
        out.by[0][k] = slope[k];
        out.by[1][k] = i * slope[k];
        out.by[2][k] = j * slope[k];
      }
    }
  // x = y / |y| with the noise's share in the length; derivatives by the quotient rule.
  centre(out.x);
  const double length = std::sqrt(dot(out.x, out.x) + kValues * noise);
  for (double& x : out.x) x /= length;
  for (Values& by : out.by) {
    centre(by);
    for (double& y : by) y /= length;
    add(-dot(out.x, by), out.x, by);
  }
  return out;
}

/// What is fitted.
struct Problem {
  std::span<const MatchView> views;
  std::span<const int> chosen;
  int held = -1;  // slot of the view that is held out
  Frame frame;
  double noise = 0;
  const FitOptions& options;
};

/// The views that count, and how much.
struct WeighedSights {
  std::vector<Sight> sights;
  std::vector<double> weights;
  double total = 0;
};

/// Fills the scores of the model.
WeighedSights weigh(const Problem& problem, const dvec3& theta, Model& model) {
  const FitOptions& options = problem.options;
  const double noise = options.noise * problem.noise * problem.noise;
  WeighedSights out;
  Values sum{};
  double scores = 0;
  int scored = 0;
  for (std::size_t slot = 0; slot < problem.chosen.size(); ++slot) {
    const MatchView& view = problem.views[std::size_t(problem.chosen[slot])];
    const Sight sight = look(view, problem.frame, theta, noise);
    if (!sight.before_camera) continue;
    const double correlation = out.total > 0 ? dot(sight.x, sum) / out.total : 0;
    if (int(slot) == problem.held) {
      model.held = correlation;
      continue;
    }
    double weight = 1;
    if (out.total > 0) {
      const double share = std::clamp(
          (correlation - options.least_score) / (options.full_score - options.least_score), 0.0,
          1.0);
      weight = share * share;
      scores += std::max(correlation, options.least_score);
      ++scored;
    }
    add(weight, sight.x, sum);
    out.total += weight;
    out.sights.push_back(sight);
    out.weights.push_back(weight);
  }
  if (scored) model.score = scores / scored;
  return out;
}

Model evaluate(const Problem& problem, const dvec3& theta) {
  Model out;
  const auto [sights, weights, total] = weigh(problem, theta, out);
  if (sights.empty()) return out;

  Values mean{};
  std::array<Values, 3> mean_by{};
  for (std::size_t v = 0; v < sights.size(); ++v) {
    add(weights[v] / total, sights[v].x, mean);
    for (int p = 0; p < 3; ++p) add(weights[v] / total, sights[v].by[p], mean_by[p]);
  }
  double cost = 0, floors = 0;
  for (std::size_t v = 0; v < sights.size(); ++v) {
    Values difference = sights[v].x;
    add(-1, mean, difference);
    cost += weights[v] * dot(difference, difference);
    floors += weights[v] / total * (1 - dot(sights[v].x, sights[v].x));
    std::array<Values, 3> by = sights[v].by;
    for (int p = 0; p < 3; ++p) {
      add(-1, mean_by[p], by[p]);
      out.gradient[p] += weights[v] * dot(by[p], difference);
    }
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) out.hessian[p][q] += weights[v] * dot(by[p], by[q]);
  }
  out.variance = std::max(cost / std::max(total - 1, 0.5), floors) / kValues;
  for (std::size_t v = 0; v < sights.size(); ++v)
    out.noise += weights[v] * sights[v].texels_per_voxel * sights[v].texels_per_voxel;
  out.noise *= kDerivativeNoise * kValues * out.variance * std::max(1 - 1 / total, 0.0);
  return out;
}

}  // namespace

FittedPatch fit_patch(std::span<const MatchView> views, std::span<const int> chosen,
                      const FitSurfel& surfel, double noise_sigma, const FitOptions& options) {
  FittedPatch out;
  out.normal = surfel.normal;
  if (chosen.size() < 2) return out;
  const MatchView& reference = views[std::size_t(chosen[0])];
  const double pixel =
      glm::distance(reference.camera.centre, surfel.position) / reference.camera.focal;
  Frame frame{surfel.position, surfel.normal, {}, {}, 0, surfel.curvature};
  frame.spacing = std::max(options.least_spacing, options.pixel_spacing * pixel);
  const auto [u, v] = tangent_axes(surfel.normal);
  frame.u = frame.spacing * u, frame.v = frame.spacing * v;
  const int held = surfel.hold_out && chosen.size() > 3 ? int(chosen.size()) - 1 : -1;
  const double steep = options.slope * frame.spacing;

  Model best;
  dvec3 theta(0), best_theta(0);
  double damping = 0.01;
  for (int step = 0; step <= options.steps; ++step) {
    const Model model = evaluate({views, chosen, held, frame, noise_sigma, options}, theta);
    if (step == 0) out.held_before = model.held;
    if (step == 0 || model.score > best.score) {
      best = model, best_theta = theta;
      damping *= 0.5;
    } else {
      damping *= 10;
    }
    const double prior = best.variance / (steep * steep);
    dmat3 a = best.hessian;
    for (int p = 0; p < 3; ++p) a[p][p] += damping * a[p][p] + (p ? prior : 0) + 1e-4;
    dvec3 move = -glm::inverse(a) * (best.gradient + prior * dvec3(0, best_theta.y, best_theta.z));
    if (std::abs(move.x) > options.largest_step) move *= options.largest_step / std::abs(move.x);
    theta = best_theta + move;
    theta.x = std::clamp(theta.x, -options.largest_offset, options.largest_offset);
    for (int p = 1; p < 3; ++p) theta[p] = std::clamp(theta[p], -3 * steep, 3 * steep);
  }

  // The offset's share of the covariance, the slopes' prior included, the noise's own derivatives
  // taken out (a slope's: by the mean square of -2 to 2, which is 2).
  dmat3 joint = best.hessian;
  joint[0][0] -= best.noise;
  for (int p = 1; p < 3; ++p)
    joint[p][p] =
        std::max(joint[p][p] - 2 * best.noise, 0.0) + best.variance / (steep * steep) + 1e-6;
  const dvec2 coupling(joint[0][1], joint[0][2]);
  const glm::dmat2 slopes(joint[1][1], joint[1][2], joint[2][1], joint[2][2]);
  const double marginal = joint[0][0] - (coupling.x * coupling.x * slopes[1][1] -
                                         2 * coupling.x * coupling.y * slopes[0][1] +
                                         coupling.y * coupling.y * slopes[0][0]) /
                                            std::max(glm::determinant(slopes), 1e-12);
  if (best.score > kNoScore && best.variance > 0)
    out.information = std::max(marginal, 0.0) / best.variance;
  out.offset = best_theta.x;
  out.normal =
      glm::normalize(surfel.normal - (best_theta.y * u + best_theta.z * v) / frame.spacing);
  out.score = best.score;
  out.held_after = best.held;
  return out;
}

}  // namespace photohull::refine::reference
