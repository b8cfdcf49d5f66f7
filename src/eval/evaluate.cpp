#include "eval/evaluate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/box.h"
#include "core/error.h"
#include "core/option_word.h"
#include "eval/nearest_sample.h"
#include "eval/surface_samples.h"
#include "eval/topology.h"
#include "raycast/closest_point.h"

namespace photohull::eval {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kPointCell = 0.0005;  ///< of the diagonal: what point clouds are thinned to
constexpr std::size_t kMostThresholds = 1000;
constexpr double kUnseenReach = 0.05;  ///< of the diagonal: farther results count as seen

/// Calls function(i, hint) for all i < count in parallel, in blocks between which a user can
/// cancel. `hint` is 0 or what the call for a neighbouring index left there.
template <typename Function>
void for_each_index(std::size_t count, Progress& progress, Function function) {
  constexpr std::size_t kBlock = 16384;
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    progress.check_cancelled();
    progress.update(double(begin) / double(count));
    tbb::parallel_for(tbb::blocked_range(begin, std::min(count, begin + kBlock), 256),
                      [&](const auto& range) {
                        std::uint32_t hint = 0;
                        for (std::size_t i = range.begin(); i != range.end(); ++i)
                          function(i, hint);
                      });
  }
  progress.check_cancelled();
}

/// The result's samples and what the truth says of each.
struct Measured {
  std::vector<double> distance;
  std::vector<double> signed_distance;  ///< empty where the truth is points
  std::vector<double> angle;            ///< degrees; empty for points
  std::vector<char> seen;
};

/// Which samples lie over surface that enough cameras see.
std::vector<char> seen_of(const SurfaceSamples& samples, const Truth& truth,
                          const std::vector<double>& distance, int min_views, Progress& progress) {
  std::vector<char> seen(samples.points.size(), 1);
  if (!truth.has_views()) return seen;
  const NearestSample nearest(truth.samples());
  for_each_index(samples.points.size(), progress, [&](std::size_t i, std::uint32_t&) {
    if (distance[i] > kUnseenReach * truth.diagonal()) return;
    seen[i] = truth.views()[nearest.find(samples.points[i]).index] >= min_views;
  });
  return seen;
}

Measured measure(const TriMesh& result, const SurfaceSamples& samples, const Truth& truth,
                 int min_views, Progress& progress) {
  const std::size_t count = samples.points.size();
  Measured m;
  m.distance.resize(count);
  if (truth.is_points()) {
    for_each_index(count, progress, [&](std::size_t i, std::uint32_t&) {
      m.distance[i] = truth.distance(samples.points[i]);
    });
    m.seen = seen_of(samples, truth, m.distance, min_views, progress);
    return m;
  }
  m.signed_distance.resize(count);
  if (!samples.triangles.empty()) m.angle.resize(count);
  for_each_index(count, progress, [&](std::size_t i, std::uint32_t& hint) {
    const SignedDistance::Value value = truth.surface().at(samples.points[i], hint);
    hint = value.hint;
    m.signed_distance[i] = value.distance;
    m.distance[i] = std::abs(value.distance);
    if (m.angle.empty()) return;
    const glm::dvec3 n = area_vector(result, samples.triangles[i]);
    m.angle[i] =
        180 / kPi * std::atan2(glm::length(glm::cross(n, value.normal)), glm::dot(n, value.normal));
  });
  m.seen = seen_of(samples, truth, m.distance, min_views, progress);
  return m;
}

std::vector<double> pick(const std::vector<double>& values, const std::vector<char>& wanted) {
  std::vector<double> picked;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (wanted[i]) picked.push_back(values[i]);
  return picked;
}

Score score_at(double distance, double diagonal, const std::vector<double>& to_truth,
               const std::vector<double>& to_result) {
  Score s{distance / diagonal, distance, share_within(to_truth, distance),
          share_within(to_result, distance), 0};
  const double sum = s.precision + s.recall;
  s.f = sum > 0 ? 2 * s.precision * s.recall / sum : 0;
  return s;
}

double mean_of(const std::vector<double>& values) { return distance_stats(values).mean; }

Part sum_up(const Measured& m, const std::vector<char>& wanted,
            const std::vector<double>& to_result, double diagonal, const EvaluateOptions& options) {
  const std::vector<double> distance = pick(m.distance, wanted);
  Part part;
  part.share = double(distance.size()) / double(m.distance.size());
  part.accuracy = quantile(distance, kAccuracyShare);
  part.to_truth = distance_stats(distance);
  if (!m.signed_distance.empty()) part.mean_signed = mean_of(pick(m.signed_distance, wanted));
  for (const double t : options.thresholds) {
    part.scores.push_back(score_at(t * diagonal, diagonal, distance, to_result));
    part.scores.back().threshold = t;
  }
  for (const double d : options.absolute)
    part.absolute.push_back(score_at(d, diagonal, distance, to_result));
  if (!m.angle.empty()) {
    const std::vector<double> angle = pick(m.angle, wanted);
    part.normals = {mean_of(angle), quantile(angle, 0.5), share_within(angle, 10)};
  }
  return part;
}

/// The samples of the truth that the result should come near to.
std::vector<glm::dvec3> wanted_samples(const Truth& truth, const EvaluateOptions& options) {
  if (!truth.has_views() && truth.is_points())
    return thin_points(truth.mesh(), kPointCell * truth.diagonal()).points;
  if (!truth.has_views())
    return sample_surface(truth.mesh(), std::size_t(options.samples), options.seed + 1).points;
  std::vector<glm::dvec3> wanted;
  for (std::size_t i = 0; i < truth.samples().size(); ++i)
    if (truth.views()[i] >= options.min_views) wanted.push_back(truth.samples()[i]);
  if (wanted.empty())
    throw Error(concat("no sample of the truth is seen by ", options.min_views,
                       " or more cameras; lower ", option_word("min_views")));
  return wanted;
}

std::vector<double> distances_to_result(const std::vector<glm::dvec3>& wanted,
                                        const TriMesh& surface, const SurfaceSamples& samples,
                                        Progress& progress) {
  std::vector<double> distance(wanted.size());
  if (!surface.triangles.empty()) {
    const ClosestPoint nearest(surface);
    for_each_index(wanted.size(), progress, [&](std::size_t i, std::uint32_t& hint) {
      const NearestPoint found = nearest.nearest(wanted[i], hint);
      distance[i] = found.distance;
      hint = found.triangle;
    });
  } else {
    const NearestSample nearest(samples.points);
    for_each_index(wanted.size(), progress, [&](std::size_t i, std::uint32_t&) {
      distance[i] = nearest.find(wanted[i]).distance;
    });
  }
  return distance;
}

void check_result(const TriMesh& result) {
  if (result.positions.empty()) throw Error("the result has no vertices; give a mesh");
  for (std::size_t i = 0; i < result.positions.size(); ++i) {
    const glm::vec3& p = result.positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error(concat("vertex ", i, " of the result is no finite point; repair the mesh"));
  }
}

double signed_volume(const TriMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += glm::dot(glm::dvec3(mesh.positions[mesh.triangles[t][0]]), area_vector(mesh, t));
  return sum / 6;
}

void describe(const TriMesh& result, const Truth& truth, Evaluation& e) {
  e.truth_name = truth.name;
  e.truth_note = truth.note;
  e.vertices = result.positions.size();
  e.faces = result.triangles.size();
  e.truth_faces = truth.mesh().triangles.size();
  e.truth_diagonal = truth.diagonal();
  e.truth_has_views = truth.has_views();
  e.truth_is_points = truth.is_points();
}

/// Without the outermost hundredth on each side, which may be debris.
Box bounds_of(const std::vector<glm::dvec3>& points) {
  constexpr double kDebris = 0.01;
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const glm::dvec3& p : points) values.push_back(p[axis]);
    box.min[axis] = quantile(values, kDebris);
    box.max[axis] = quantile(values, 1 - kDebris);
  }
  return box;
}

/// Are the result and the truth in frames that have nothing to do with each other?
void compare_frames(const std::vector<glm::dvec3>& result, const std::vector<glm::dvec3>& truth,
                    Evaluation& e) {
  constexpr double kLarger = 1.5, kSmaller = 0.25;  // which a part of the truth may be
  constexpr double kMeet = 0.2;
  const Box a = bounds_of(result), b = bounds_of(truth);
  const double ratio = a.diagonal() / b.diagonal();
  // Of either box along an axis; plates have no thickness to go by.
  double least = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double common = std::min(a.max[axis], b.max[axis]) - std::max(a.min[axis], b.min[axis]);
    const double side = std::min(a.size()[axis], b.size()[axis]);
    least = std::min(least, (common + 0.01 * b.diagonal()) / (side + 0.01 * b.diagonal()));
  }
  if (ratio < kLarger && ratio > kSmaller && least > kMeet) return;
  char text[400];
  const auto part = [&](const char* format, auto... values) {
    std::snprintf(text, sizeof text, format, values...);
    return std::string(text);
  };
  const auto corners = [&](const Box& x) {
    return part("(%.4g %.4g %.4g) to (%.4g %.4g %.4g)", x.min.x, x.min.y, x.min.z, x.max.x, x.max.y,
                x.max.z);
  };
  e.warnings.push_back(
      concat(least > kMeet ? part("the result is %.4g times as large as the truth", ratio)
                           : "the result lies elsewhere than the truth",
             " (most of it in ", corners(a), ", of the truth in ", corners(b),
             "): are they in one frame and unit? ", option_word("align"), " aligns them"));
}

void check_volume(const TriMesh& result, const Truth& truth, Evaluation& e) {
  if (e.points) {
    e.volume.reason = "the result has no faces";
    return;
  }
  if (truth.is_points()) {
    e.volume.reason = "the truth has no faces";
    return;
  }
  e.volume = measure_overlap(result, truth.mesh(), e.options.columns);
  if (!e.volume.known) return;
  if (signed_volume(result) < 0)
    e.warnings.push_back("the result's faces look inwards: its normals count as opposite");
  if (signed_volume(truth.mesh()) < 0)
    e.warnings.push_back("the truth's faces look inwards: signs and normals count as opposite");
}

}  // namespace

void describe(Described& to, EvaluateOptions& o) {
  to.list("thresholds", &o.thresholds, above(0, 1), "fractions above 0 and up to 1",
          "distances to count within, fractions of the truth's diagonal");
  to.list("absolute", &o.absolute, above(0), "distances above 0",
          "further distances to count within, in world units");
  to.number("samples", &o.samples, from_to(1000, 20000000), "", "points to measure the result at");
  to.number("seed", &o.seed, at_least(0), "",
            "seed of the random numbers that choose these points");
  to.number("min_views", &o.min_views, from_to(1, 255), "",
            "cameras that must see a part of the truth for it to count");
  to.number("columns", &o.columns, from_to(16, 4096), "",
            "columns of rays along a side of the box, by which volumes are compared");
}

void EvaluateOptions::validate() const {
  check_options(*this);
  if (thresholds.empty() || thresholds.size() > kMostThresholds ||
      absolute.size() > kMostThresholds)
    throw UsageError(concat(option_word("thresholds"), " and ", option_word("absolute"),
                            " take up to ", kMostThresholds, " values, the former at least one"));
}

Evaluation evaluate(const TriMesh& result, const Truth& truth, const EvaluateOptions& options,
                    Progress* given) {
  Progress silent;
  Progress& progress = given ? *given : silent;
  options.validate();
  check_result(result);
  Evaluation e;
  e.options = options;
  describe(result, truth, e);
  const TriMesh surface = without_degenerate_faces(result);
  e.points = surface.triangles.empty();
  if (e.points && e.faces > 0)
    e.warnings.push_back("no face of the result has an area: it is judged as points");
  const std::vector<glm::dvec3> wanted = wanted_samples(truth, options);
  e.truth_samples = truth.has_views() ? truth.samples().size() : wanted.size();
  e.truth_samples_seen = wanted.size();

  progress.stage("result to truth", 4);
  const SurfaceSamples samples =
      e.points ? thin_points(result, kPointCell * truth.diagonal())
               : sample_surface(surface, std::size_t(options.samples), options.seed);
  e.result_samples = samples.points.size();
  e.result_area = samples.area;
  if (!e.points || samples.points.size() > 1)
    compare_frames(samples.points, truth.has_views() ? truth.samples() : wanted, e);
  Measured measured = measure(surface, samples, truth, options.min_views, progress);

  progress.stage("truth to result", 4);
  const std::vector<double> to_result = distances_to_result(wanted, surface, samples, progress);

  progress.stage("volumes", 2);
  const std::vector<char> everything(samples.points.size(), 1);
  const bool none_seen = std::count(measured.seen.begin(), measured.seen.end(), 1) == 0;
  if (none_seen) {
    e.warnings.push_back("no camera sees any of the result: 'seen' counts all of it");
    measured.seen = everything;
  }
  e.all = sum_up(measured, everything, to_result, truth.diagonal(), options);
  e.seen = sum_up(measured, measured.seen, to_result, truth.diagonal(), options);
  if (none_seen) e.seen.share = 0;
  e.to_result = distance_stats(to_result);
  e.completeness = share_within(to_result, kCompletenessThreshold * truth.diagonal());
  e.hausdorff95 = std::max(e.all.to_truth.q95, e.to_result.q95);
  e.chamfer = 0.5 * (e.all.to_truth.mean + e.to_result.mean);
  check_volume(result, truth, e);
  return e;
}

}  // namespace photohull::eval
