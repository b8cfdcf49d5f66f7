#include "synth/place_cameras.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "synth/random.h"

namespace photohull::synth {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGoldenAngle = 2.399963229728653;

glm::dvec3 direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::sin(azimuth), -std::cos(elevation) * std::cos(azimuth),
          std::sin(elevation)};
}

/// Of a ring's view, in full turns; crowding gathers the views after the first one and leaves a gap
/// before it.
double ring_turn(const CameraSpec& c, const Ring& ring, int view) {
  const double even = (view + ring.phase) / ring.count;
  const double whole = std::floor(even);
  return whole + std::pow(even - whole, c.crowding);
}

/// Unit vectors from the middle of the box to the cameras.
std::vector<glm::dvec3> directions(const CameraSpec& c) {
  std::vector<glm::dvec3> all;
  const double azimuth = glm::radians(c.azimuth);
  if (c.layout == "rings")
    for (const Ring& ring : c.rings)
      for (int i = 0; i < ring.count; ++i)
        all.push_back(
            direction(azimuth + 2 * kPi * ring_turn(c, ring, i), glm::radians(ring.elevation)));
  if (c.layout == "hemisphere") {
    const double low = std::sin(glm::radians(c.lowest)), high = std::sin(glm::radians(c.highest));
    for (int i = 0; i < c.count; ++i)
      all.push_back(direction(azimuth + kGoldenAngle * i,
                              std::asin(low + (high - low) * (i + 0.5) / c.count)));
  }
  if (c.layout == "arc") {
    const double span = glm::radians(c.arc);
    // A full circle does not take its first picture twice.
    const int steps = c.arc >= 360 ? c.count : std::max(1, c.count - 1);
    const double start = c.count == 1 ? 0 : -span / 2;
    for (int i = 0; i < c.count; ++i)
      all.push_back(direction(azimuth + start + span * i / steps, glm::radians(c.elevation)));
  }
  if (c.layout == "within")
    for (int i = 0; i < c.count; ++i)
      all.push_back(direction(azimuth + 2 * kPi * i / c.count, glm::radians(c.elevation)));
  return all;
}

/// What the i-th camera looks at: the middle, or where it is turned to.
glm::dvec3 target_of(const CameraSpec& c, const glm::dvec3& middle, const glm::dvec3& eye,
                     std::size_t i) {
  if (c.layout != "within") return middle;
  const double turn = glm::radians(c.turns[i % c.turns.size()]), pitch = glm::radians(c.pitch);
  const glm::dvec2 ahead = normalize(glm::dvec2(middle - eye));
  return eye + std::cos(pitch) * glm::dvec3(std::cos(turn) * ahead.x - std::sin(turn) * ahead.y,
                                            std::sin(turn) * ahead.x + std::cos(turn) * ahead.y,
                                            -std::tan(pitch));
}

Pose look_at(const glm::dvec3& eye, const glm::dvec3& target, double roll) {
  const glm::dvec3 forward = normalize(target - eye);
  glm::dvec3 right = cross(forward, glm::dvec3(0, 0, 1));
  right = length(right) > 1e-9 ? normalize(right) : glm::dvec3(1, 0, 0);
  const glm::dvec3 down = cross(forward, right);
  const glm::dvec3 x = std::cos(roll) * right + std::sin(roll) * down;
  const glm::dvec3 y = cross(forward, x);
  Pose pose;
  pose.rotation = transpose(glm::dmat3(x, y, forward));
  pose.translation = -(pose.rotation * eye);
  return pose;
}

/// Is the point enclosed: do all rays from it meet the surface from behind?
bool is_inside(const Surface& surface, const glm::dvec3& point) {
  constexpr int kRays = 32;
  for (int i = 0; i < kRays; ++i) {
    const glm::dvec3 d = direction(kGoldenAngle * i, std::asin(-1 + 2 * (i + 0.5) / kRays));
    const auto hit = surface.rays->closest(point, d);
    if (!hit || dot(d, glm::dvec3(surface.face_normals[hit->triangle])) <= 0) return false;
  }
  return true;
}

/// What is to be in the frame: all vertices; of what moves, the corners of the box of all frames.
std::vector<glm::dvec3> points_to_show(const Surface& surface) {
  std::vector<glm::dvec3> points;
  if (!surface.moves)
    for (std::size_t i = 0; i < surface.mesh.positions.size(); ++i)
      points.push_back(surface.mesh.world(i));
  else
    for (int corner = 0; corner < 8; ++corner)
      points.push_back(mix(surface.box.min, surface.box.max,
                           glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2)));
  return points;
}

/// Half the larger of width and height that the points need for focal length 1, where the frame's
/// sides are 2 x aspect.
double half_extent(const std::vector<glm::dvec3>& points, double diagonal, const Pose& pose,
                   double aspect, std::size_t view) {
  double extent = 0, nearest = INFINITY;
  for (const glm::dvec3& point : points) {
    const glm::dvec3 p = pose.rotation * point + pose.translation;
    nearest = std::min(nearest, p.z);
    extent = std::max({extent, std::abs(p.x) / (p.z * aspect), std::abs(p.y) / p.z});
  }
  if (!(nearest > 1e-3 * diagonal))
    throw Error(concat("cameras: the object reaches behind or into the camera of view ", view,
                       "; raise cameras.distance or cameras.distances"));
  return extent;
}

void check_lens(const LensCamera& lens) {
  const Intrinsics& k = lens.camera.intrinsics;
  for (int y = 0; y <= 64; ++y)
    for (int x = 0; x <= 64; ++x)
      if (!lens.undistorted({-0.5 + k.width * x / 64.0, -0.5 + k.height * y / 64.0}))
        throw Error(
            "degradations: a lens of this k1, k2, p1, p2 folds over within the frame; lower them");
}

}  // namespace

std::vector<LensCamera> place_cameras(const Spec& spec, const Surface& surface) {
  const CameraSpec& c = spec.cameras;
  const double width = spec.image.width, height = spec.image.height;
  std::vector<LensCamera> all;
  const bool within = c.layout == "within";  // what surrounds a camera does not fit a frame
  const std::vector<glm::dvec3> points = points_to_show(surface);
  double largest = 0;
  for (const glm::dvec3& d : directions(c)) {
    const std::size_t i = all.size();
    LensCamera lens;
    const glm::dvec3 target = surface.box.center();
    const double distance = c.distance * c.distances[i % c.distances.size()] * surface.diagonal;
    const glm::dvec3 eye = target + distance * d;
    if (is_inside(surface, eye))
      throw Error(concat("cameras: the camera of view ", i,
                         " is inside the object; raise cameras.distance or cameras.distances"));
    const double roll = glm::radians(c.roll) * (2 * Random(spec.seed, 0x7011, i).uniform() - 1);
    lens.camera.cam_from_world = look_at(eye, target_of(c, target, eye, i), roll);
    const double focal = c.focals[i % c.focals.size()];
    lens.camera.intrinsics.fx = focal;
    if (!within)
      largest =
          std::max(largest, focal * half_extent(points, surface.diagonal,
                                                lens.camera.cam_from_world, width / height, i));
    all.push_back(lens);
  }
  const DegradationSpec& g = spec.degradations;
  for (LensCamera& lens : all) {
    Intrinsics& k = lens.camera.intrinsics;
    k.width = spec.image.width, k.height = spec.image.height;
    k.fx = k.fy = k.fx * (within ? width / 2 / std::tan(glm::radians(c.field_of_view) / 2)
                                 : c.fill * height / 2 / largest);
    k.cx = (width - 1) / 2 + c.principal_offset.x;
    k.cy = (height - 1) / 2 + c.principal_offset.y;
    if (g.k1 != 0 || g.k2 != 0 || g.p1 != 0 || g.p2 != 0)
      lens.distortion = {DistortionModel::kBrown, {g.k1, g.k2, g.p1, g.p2}};
    check_lens(lens);
  }
  return all;
}

}  // namespace photohull::synth
