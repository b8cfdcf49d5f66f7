#include "synth/degrade_cameras.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <numeric>

#include "core/box.h"
#include "core/error.h"

namespace photohull::synth {
namespace {

using Cameras = std::vector<LensCamera>;
enum Stream : std::uint64_t { kWrongViews = 0x3207, kShiftedViews = 0x3208 };

/// The distance at which the points lie, on average.
double mean_depth(const LensCamera& lens, const std::vector<glm::dvec3>& points) {
  double sum = 0;
  for (const glm::dvec3& p : points) sum += lens.camera.to_camera(p).z;
  return sum / double(points.size());
}

/// Turned and moved, both by about `pixels`.
LensCamera move(const LensCamera& lens, Random random, double depth, double pixels) {
  LensCamera moved = lens;
  const double step = pixels / lens.camera.intrinsics.fx;
  glm::dvec3 turn, shift;
  for (int axis = 0; axis < 3; ++axis)
    turn[axis] = step * random.normal(), shift[axis] = step * depth * random.normal();
  const double angle = length(turn);
  Pose& pose = moved.camera.cam_from_world;
  if (angle > 0)
    pose.rotation = glm::mat3_cast(glm::angleAxis(angle, turn / angle)) * pose.rotation;
  pose.translation = -(pose.rotation * lens.camera.center()) + shift;
  return moved;
}

/// `perturb(scale)` with the scale that gives the error asked for; the error grows about
/// proportionally, so that dividing by it converges at once.
Cameras scaled(const Cameras& exact, const std::vector<glm::dvec3>& points, double error,
               const std::function<Cameras(double)>& perturb) {
  double scale = error;
  Cameras result;
  for (int round = 0; round < 100; ++round) {
    result = perturb(scale);
    const double found = reprojection_error(exact, result, points);
    if (std::abs(found - error) < 1e-10 * error) return result;
    if (!(found > 0) || !std::isfinite(found)) break;
    scale *= error / found;
  }
  throw Error(concat("degradations: cameras cannot be put off by ", error,
                     " pixels; lower pose_error and intrinsics_error"));
}

}  // namespace

double reprojection_error(const Cameras& a, const Cameras& b,
                          const std::vector<glm::dvec3>& points) {
  PHOTOHULL_CHECK_OP(a.size(), ==, b.size());
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (const glm::dvec3& point : points) {
      const auto p = a[i].project(point), q = b[i].project(point);
      if (!p || !q) continue;
      sum += dot(*p - *q, *p - *q);
      ++count;
    }
  return count ? std::sqrt(sum / double(count)) : 0;
}

namespace {

/// Off in their poses and intrinsics by the sizes asked for.
Cameras miscalibrated(const Cameras& cameras, const DegradationSpec& spec, std::uint64_t seed,
                      const std::vector<glm::dvec3>& points) {
  Cameras posed = cameras;
  if (spec.pose_error > 0)
    posed = scaled(cameras, points, spec.pose_error, [&](double scale) {
      Cameras moved;
      for (std::size_t i = 0; i < cameras.size(); ++i)
        moved.push_back(
            move(cameras[i], Random(seed, 0x905e, i), mean_depth(cameras[i], points), scale));
      return moved;
    });
  if (spec.intrinsics_error <= 0) return posed;
  Random random(seed, 0x1275);
  const double focal = random.normal();
  const double down = random.normal(), right = random.normal();
  const glm::dvec2 principal(right, down);
  const auto with_error = [&](Cameras set, double scale) {
    for (LensCamera& lens : set) {
      Intrinsics& k = lens.camera.intrinsics;
      const double zoom = 1 + 4 * scale * focal / k.height;
      k.fx *= zoom, k.fy *= zoom;
      k.cx += scale * principal.x, k.cy += scale * principal.y;
    }
    return set;
  };
  const Cameras off = scaled(cameras, points, spec.intrinsics_error,
                             [&](double scale) { return with_error(cameras, scale); });
  for (std::size_t i = 0; i < posed.size(); ++i)
    posed[i].camera.intrinsics = off[i].camera.intrinsics;
  return posed;
}

/// Views chosen at random, their poses those of a camera turned about the middle of the points
/// around an axis at random: they still look at the object.
void turn_away(Cameras& cameras, const DegradationSpec& spec, std::uint64_t seed,
               const std::vector<glm::dvec3>& points) {
  const auto count = std::size_t(std::lround(spec.wrong_views * double(cameras.size())));
  const std::vector<std::size_t> order = random_order(cameras.size(), Random(seed, kWrongViews));
  Box box{points.front(), points.front()};
  for (const glm::dvec3& p : points) box.min = min(box.min, p), box.max = max(box.max, p);
  const glm::dvec3 middle = box.center();
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, kWrongViews, order[i] + 1);
    glm::dvec3 axis(0, 0, 1);
    for (int tries = 0; tries < 100; ++tries) {
      axis = {random.normal(), random.normal(), random.normal()};
      if (length(axis) > 0.1) break;
    }
    const glm::dmat3 turn =
        glm::mat3_cast(glm::angleAxis(glm::radians(spec.wrong_turn), normalize(axis)));
    Pose& pose = cameras[order[i]].camera.cam_from_world;
    pose.translation += pose.rotation * (middle - turn * middle);
    pose.rotation = pose.rotation * turn;
  }
}

/// Views chosen at random, their principal points off by the same length in directions at random.
void shift_views(Cameras& cameras, const DegradationSpec& spec, std::uint64_t seed) {
  const double share = spec.view_shift_views * double(cameras.size());
  const std::size_t count = std::size_t(std::max(1ll, std::llround(share)));
  const std::vector<std::size_t> order = random_order(cameras.size(), Random(seed, kShiftedViews));
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * Random(seed, kShiftedViews, order[i] + 1).uniform();
    Intrinsics& k = cameras[order[i]].camera.intrinsics;
    k.cx += spec.view_shift * std::cos(angle);
    k.cy += spec.view_shift * std::sin(angle);
  }
}

bool shifts_views(const DegradationSpec& spec) {
  return spec.view_shift > 0 && spec.view_shift_views > 0;
}

}  // namespace

std::vector<std::size_t> random_order(std::size_t count, Random random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t(0));
  for (std::size_t i = count; i > 1; --i)
    std::swap(order[i - 1], order[std::size_t(random.uniform() * double(i))]);
  return order;
}

Cameras degrade_cameras(const Cameras& cameras, const DegradationSpec& spec, std::uint64_t seed,
                        const std::vector<glm::dvec3>& points) {
  Cameras written = miscalibrated(cameras, spec, seed, points);
  if (spec.wrong_views > 0) turn_away(written, spec, seed, points);
  if (shifts_views(spec)) shift_views(written, spec, seed);
  for (LensCamera& lens : written) {
    lens.camera.intrinsics.cx += spec.pixel_shift.x;
    lens.camera.intrinsics.cy += spec.pixel_shift.y;
    if (spec.ignore_distortion) lens.distortion = {};
  }
  return written;
}

bool cameras_are_off(const DegradationSpec& spec) {
  return spec.pose_error > 0 || spec.intrinsics_error > 0 || spec.wrong_views > 0 ||
         shifts_views(spec) || length(spec.pixel_shift) > 0 || spec.ignore_distortion;
}

}  // namespace photohull::synth
