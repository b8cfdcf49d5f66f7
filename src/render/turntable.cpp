#include "render/turntable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.h"

namespace photohull::render {
namespace {

constexpr double kField = 24;     // degrees that the shorter side of the picture spans
constexpr double kMargin = 0.92;  // of the picture that the model may fill
constexpr double kNearest = 1.1;  // radii of the model that the camera keeps away from its middle
constexpr int kHeights = 64, kDirections = 48;  // of the body that the turning model sweeps
constexpr int kHalvings = 50;

/// The model's axis, and its frame about it.
struct Axis {
  glm::dvec3 middle, up, east, north;

  glm::dvec3 local(const glm::dvec3& world) const {
    const glm::dvec3 d = world - middle;
    return {glm::dot(d, east), glm::dot(d, north), glm::dot(d, up)};
  }
};

Axis axis_of(const TriMesh& mesh, const glm::dvec3& up) {
  const glm::dvec3 across = std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  Axis axis{mesh.origin, up, glm::normalize(glm::cross(across, up)), {}};
  axis.north = glm::cross(up, axis.east);
  glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::dvec3 p = axis.local(mesh.world(v));
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec3 m = 0.5 * (low + high);
  axis.middle += m.x * axis.east + m.y * axis.north + m.z * up;
  return axis;
}

/// Circles around the body that the turning mesh sweeps: heights, and radii there.
std::vector<glm::dvec2> swept_circles(const TriMesh& mesh, const Axis& axis) {
  std::vector<glm::dvec2> points;  // radius, height
  double low = std::numeric_limits<double>::max(), high = -low;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::dvec3 p = axis.local(mesh.world(v));
    points.emplace_back(std::hypot(p.x, p.y), p.z);
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  const double step = std::max((high - low) / kHeights, 1e-12);
  std::vector<double> radii(kHeights, -1);
  for (const glm::dvec2& p : points) {
    double& radius = radii[std::size_t(std::clamp(int((p.y - low) / step), 0, kHeights - 1))];
    radius = std::max(radius, p.x);
  }
  std::vector<glm::dvec2> circles;
  for (int i = 0; i < kHeights; ++i) {
    const double radius = radii[std::size_t(i)];
    if (radius < 0) continue;
    circles.emplace_back(radius, low + i * step);
    circles.emplace_back(radius, low + (i + 1) * step);
  }
  return circles;
}

/// Is all of it in the picture from that distance, within half of `extent` (tangents) each way?
bool fits(const std::vector<glm::dvec2>& circles, double elevation, double distance,
          const glm::dvec2& extent) {
  const double c = std::cos(elevation), s = std::sin(elevation);
  for (const glm::dvec2& circle : circles)
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2 * std::numbers::pi * k / kDirections;
      const double towards = circle.x * std::cos(angle), aside = circle.x * std::sin(angle);
      const double depth = distance - towards * c - circle.y * s;
      const double upward = circle.y * c - towards * s;
      if (depth <= 0 || std::abs(aside) > extent.x * depth || std::abs(upward) > extent.y * depth)
        return false;
    }
  return true;
}

Intrinsics lens(int width, int height, double& tangent) {
  tangent = std::tan(0.5 * kField * std::numbers::pi / 180);
  const double focal = 0.5 * std::min(width, height) / tangent;
  return {width, height, focal, focal, 0, 0.5 * (width - 1), 0.5 * (height - 1)};
}

Camera looking_at(const Axis& axis, const glm::dvec3& back, double distance,
                  const Intrinsics& lens) {
  const glm::dvec3 right = glm::normalize(glm::cross(axis.up, back));
  Camera camera{lens, {}};
  // Rows are the camera's axes: right, down, ahead.
  camera.cam_from_world.rotation =
      glm::transpose(glm::dmat3(right, glm::cross(right, back), -back));
  camera.cam_from_world.translation =
      -(camera.cam_from_world.rotation * (axis.middle + distance * back));
  return camera;
}

}  // namespace

void describe(Described& to, TurntableOptions& o) {
  to.number("frames", &o.frames, from_to(1, 3600), "", "pictures of one turn");
  to.number("elevation", &o.elevation, from_to(-80, 80), "degrees",
            "how far the turntable's camera stands above the model's middle");
}

std::vector<Shot> turntable(const TriMesh& mesh, const glm::dvec3& up, const glm::dvec3& from,
                            const TurntableOptions& options, int width, int height) {
  PHOTOHULL_CHECK(!mesh.positions.empty() && width > 0 && height > 0);
  const Axis axis = axis_of(mesh, up);
  const std::vector<glm::dvec2> circles = swept_circles(mesh, axis);
  const double elevation = options.elevation * std::numbers::pi / 180;
  double tangent = 0, radius = 1e-12;
  const Intrinsics intrinsics = lens(width, height, tangent);
  for (const glm::dvec2& circle : circles) radius = std::max(radius, glm::length(circle));
  const double shorter = std::min(width, height);
  const glm::dvec2 extent = kMargin * tangent * glm::dvec2(width / shorter, height / shorter);
  double low = kNearest * radius, high = 2 * radius / (kMargin * tangent);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (fits(circles, elevation, middle, extent) ? high : low) = middle;
  }
  const Window window{
      -0.5,         -0.5, double(width), double(height), std::max(high - radius, 1e-3 * high),
      high + radius};
  const glm::dvec3 start = axis.local(from);
  const double first = std::atan2(start.y, start.x);
  std::vector<Shot> shots;
  for (int i = 0; i < options.frames; ++i) {
    const double azimuth = first - 2 * std::numbers::pi * i / options.frames;
    const glm::dvec3 flat = std::cos(azimuth) * axis.east + std::sin(azimuth) * axis.north;
    const glm::dvec3 back = std::cos(elevation) * flat + std::sin(elevation) * up;
    shots.push_back({looking_at(axis, back, high, intrinsics), window});
  }
  return shots;
}

Shot seen_from(const TriMesh& mesh, const Camera& camera, int width, int height) {
  const Intrinsics& k = camera.intrinsics;
  const Window depths = frame_mesh(mesh, camera, 0);
  const double scale = std::max(double(k.width) / double(width), double(k.height) / double(height));
  const glm::dvec2 size = scale * glm::dvec2(width, height);
  return {camera,
          {-0.5 - 0.5 * (size.x - k.width), -0.5 - 0.5 * (size.y - k.height), size.x, size.y,
           depths.near, depths.far}};
}

}  // namespace photohull::render
