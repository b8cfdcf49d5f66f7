#include "pipeline/coverage.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/median.h"
#include "render/scene_up.h"

namespace photohull::pipeline {
namespace {

constexpr double kFacing = 45;                   // degrees between a view's axis and the middle
constexpr double kMostFacing = 0.8;              // share of the views
constexpr double kSteepest = 70;                 // degrees above or below the horizon
constexpr double kWideGap = 90, kOneSide = 180;  // degrees of azimuth without a view
constexpr std::size_t kFewestAround = 3;
constexpr int kRounds = 30;            // of iterations that converge long before
constexpr double kLeastSpread = 0.02;  // squared sine, of directions that tell an axis or a place
constexpr double kMostRoll = 0.25;     // of that spread, for what is not level
constexpr double kNearAxis = 1e-3;     // of the cameras' distance: nearer axes count no more
constexpr double kMostBefore = 0.8;    // share of the cameras that have the middle before them

double radians(double degrees) { return degrees * M_PI / 180; }

/// The horizontal one of a camera's axes to the right and down, where `up` is about right.
glm::dvec3 horizontal_axis(const Camera& camera, const glm::dvec3& up) {
  const glm::dmat3& r = camera.cam_from_world.rotation;
  const glm::dvec3 right(r[0][0], r[1][0], r[2][0]), down(r[0][1], r[1][1], r[2][1]);
  return std::abs(glm::dot(right, up)) <= std::abs(glm::dot(down, up)) ? right : down;
}

/// Mean of the squares of directions along `axis`, and its smallest value across it.
struct Spread {
  double along = 0, across = 0;
};

Spread spread_of(const glm::dmat3& squares, const glm::dvec3& axis) {
  const glm::dvec3 any = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(axis, any)), y = glm::cross(axis, x);
  const double xx = glm::dot(x, squares * x), yy = glm::dot(y, squares * y),
               xy = glm::dot(x, squares * y);
  return {glm::dot(axis, squares * axis), 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy)};
}

/// The axis that directions of these mean squares are farthest from, by inverse iteration.
glm::dvec3 least_axis(const glm::dmat3& squares, glm::dvec3 axis) {
  const glm::dmat3 inverse = glm::inverse(squares + 1e-9 * glm::dmat3(1));
  for (int round = 0; round < kRounds; ++round) axis = glm::normalize(inverse * axis);
  return axis;
}

/// Gaps between azimuths that follow one another.
void find_gaps(Coverage& coverage) {
  std::vector<const SkyPlace*> around;
  for (const SkyPlace& place : coverage.places)
    if (place.counts) around.push_back(&place);
  std::ranges::stable_sort(around, {}, &SkyPlace::azimuth);
  for (std::size_t i = 0; i < around.size(); ++i) {
    const bool last = i + 1 == around.size();
    const SkyPlace &before = *around[i], &after = *around[last ? 0 : i + 1];
    CoverageGap gap{before.azimuth, after.azimuth + (last ? 2 * M_PI : 0), before.name, after.name};
    if (gap.degrees() >= kWideGap) coverage.gaps.push_back(std::move(gap));
  }
  std::ranges::stable_sort(coverage.gaps, {}, [](const CoverageGap& g) { return g.from - g.to; });
}

/// The place that is nearest to the views' axes, each weighted.
glm::dmat3 axes_matrix(std::span<const SourceView> views, std::span<const double> weights,
                       glm::dvec3& sum) {
  glm::dmat3 matrix(0);
  sum = glm::dvec3(0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const glm::dvec3 way = views[i].camera.forward();
    const glm::dmat3 across = weights[i] * (glm::dmat3(1) - glm::outerProduct(way, way));
    matrix += across;
    sum += across * views[i].camera.center();
  }
  return matrix;
}

}  // namespace

long CoverageGap::degrees() const { return std::lround((to - from) * 180 / M_PI); }

Coverage find_coverage(std::span<const SourceView> views, const glm::dvec3& middle,
                       const glm::dvec3& up) {
  const glm::dvec3 world = std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(world - glm::dot(world, up) * up), y = glm::cross(up, x);
  Coverage coverage;
  std::size_t facing = 0, level = 0;
  for (const SourceView& view : views) {
    const glm::dvec3 way = view.camera.center() - middle;
    const double distance = glm::length(way), height = glm::dot(way, up);
    SkyPlace place{view.name, 0, 0.5 * M_PI};
    if (distance > 0) {
      place.azimuth = std::atan2(glm::dot(way, y), glm::dot(way, x));
      place.elevation = std::asin(std::clamp(height / distance, -1.0, 1.0));
    }
    const bool faces = distance > 0 && glm::dot(view.camera.forward(), way) <=
                                           -distance * std::cos(radians(kFacing));
    place.counts = faces && std::abs(place.elevation) < radians(kSteepest);
    facing += faces, level += place.counts;
    coverage.places.push_back(std::move(place));
  }
  coverage.judged = double(facing) >= kMostFacing * double(views.size()) && 2 * level >= facing &&
                    level >= kFewestAround;
  if (coverage.judged) find_gaps(coverage);
  return coverage;
}

glm::dvec3 level_up(std::span<const SourceView> views, const glm::dvec3& middle) {
  std::vector<Camera> cameras;
  for (const SourceView& view : views) cameras.push_back(view.camera);
  const glm::dvec3 start = render::scene_up(cameras, middle);
  if (cameras.empty()) return start;
  glm::dvec3 up = start;
  Spread spread;
  for (int round = 0; round < 5; ++round) {
    glm::dmat3 squares(0);
    for (const Camera& camera : cameras) {
      const glm::dvec3 axis = horizontal_axis(camera, up);
      squares += glm::outerProduct(axis, axis) / double(cameras.size());
    }
    up = least_axis(squares, up);
    spread = spread_of(squares, up);
  }
  const bool told = spread.across > kLeastSpread && spread.along < kMostRoll * spread.across;
  return !told ? start : glm::dot(up, start) < 0 ? -up : up;
}

glm::dvec3 find_middle(std::span<const SourceView> views, std::span<const glm::dvec3> points) {
  glm::dvec3 usual(0);
  for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
    std::vector<double> values;
    for (const glm::dvec3& p : points) values.push_back(p[axis]);
    usual[axis] = median(values);
  }
  if (views.empty()) return usual;
  std::vector<double> weights(views.size(), 1 / double(views.size()));
  glm::dvec3 sum, middle(0);
  const glm::dmat3 even = axes_matrix(views, weights, sum);
  // What lies across all axes: the way in which the place is told least.
  const double determined = glm::dot(least_axis(even, views[0].camera.forward()),
                                     even * least_axis(even, views[0].camera.forward()));
  if (!(determined > kLeastSpread)) return usual;
  middle = glm::inverse(even) * sum;
  for (int round = 0; round < kRounds; ++round) {  // to the least sum of distances
    for (std::size_t i = 0; i < views.size(); ++i) {
      const glm::dvec3 way = middle - views[i].camera.center();
      const double off = glm::length(glm::cross(views[i].camera.forward(), way));
      weights[i] = 1 / std::max(off, kNearAxis * glm::length(way) + 1e-300);
    }
    const glm::dmat3 matrix = axes_matrix(views, weights, sum);
    middle = glm::inverse(matrix) * sum;
  }
  const auto before = std::ranges::count_if(
      views, [&](const SourceView& view) { return view.camera.to_camera(middle).z > 0; });
  const bool sees = double(before) >= kMostBefore * double(views.size());
  return sees ? middle : usual;
}

std::string coverage_warning(const Coverage& coverage, const std::string& picture) {
  if (coverage.gaps.empty()) return "";
  const CoverageGap& widest = coverage.gaps.front();
  const std::string where = picture.empty() ? "" : concat("; ", picture, " shows where");
  if (widest.degrees() >= kOneSide)
    return concat("all photographs were taken from one side: as seen from above they span ",
                  360 - widest.degrees(), " degrees, from ", widest.after, " to ", widest.before,
                  "; what lies behind is not known, unless you photograph it, too", where);
  std::string gaps;
  for (const CoverageGap& gap : coverage.gaps)
    gaps += concat(gaps.empty() ? "" : ", and ", "over ", gap.degrees(), " degrees, between ",
                   gap.before, " and ", gap.after);
  return concat("as seen from above no photograph was taken ", gaps, ": photograph ",
                coverage.gaps.size() == 1 ? "that side" : "those sides", ", too", where);
}

}  // namespace photohull::pipeline
