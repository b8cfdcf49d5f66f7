#include "cameras/moved_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>

namespace photohull {
namespace {

using glm::cross;
using glm::dmat3;
using glm::dot;
using glm::dvec2;
using glm::dvec3;

dmat3 cross_matrix(const dvec3& v) {
  return dmat3(0, v.z, -v.y, -v.z, 0, v.x, v.y, -v.x, 0);  // by columns
}

struct Turn {
  dmat3 rotation, left_jacobian;
};

/// The rotation of a rotation vector w (Rodrigues), and its left Jacobian J: a small change dw
/// turns what is rotated by the vector J dw [Barfoot17].
Turn turn_by(const dvec3& w) {
  const double t2 = dot(w, w), t = std::sqrt(t2);
  const bool small = t < 1e-4;  // where the series' next term is below rounding
  const double a = small ? 1 - t2 / 6 : std::sin(t) / t;
  const double b = small ? 0.5 - t2 / 24 : (1 - std::cos(t)) / t2;
  const double c = small ? 1.0 / 6 - t2 / 120 : (1 - a) / t2;
  const dmat3 k = cross_matrix(w), kk = k * k, one(1.0);
  return {one + a * k + b * kk, one + b * k + c * kk};
}

dvec3 rotation_vector(const dmat3& r) {
  Eigen::Matrix3d m;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) m(row, column) = r[column][row];
  const Eigen::AngleAxisd turn(m);
  const Eigen::Vector3d v = turn.angle() * turn.axis();
  return {v.x(), v.y(), v.z()};
}

/// Where a pixel's ray points, with depth 1.
dvec3 ray_of(const Intrinsics& k, const SharedUnknowns& shared, double f, const dvec2& pixel) {
  const double y = (pixel.y - k.cy - shared[2]) / (f * k.fy);
  return {(pixel.x - k.cx - shared[1]) / (f * k.fx) - k.skew * y / k.fx, y, 1};
}

void put(std::array<double, 6>& row, const dvec3& turn, const dvec3& move) {
  for (int i = 0; i < 3; ++i) {
    row[std::size_t(i)] = turn[i];
    row[std::size_t(3 + i)] = move[i];
  }
}

/// A camera in a tangent's residual.
struct Looking {
  const MovedCamera& camera;
  const SharedUnknowns& shared;
  double focal;
  dvec3 local;  ///< the pixel's ray in the camera's frame, with depth 1
  dvec3 ray;    ///< the same in world axes

  Looking(const MovedCamera& moved, const SharedUnknowns& all, const dvec2& pixel)
      : camera(moved),
        shared(all),
        focal(std::exp(all[0] * kFocalUnit)),
        local(ray_of(moved.intrinsics, all, focal, pixel)),
        ray(local * moved.pose.rotation) {}  // from the left: by the transposed matrix
};

/// Derivatives of a distance by the vectors that it is made of.
struct ByVectors {
  dvec3 center, ray;  ///< of the camera
  dvec3 turn{0.0};    ///< of the rotation vector in world axes, beyond what moves the ray
};

/// By the camera's unknowns and what it shares, with the derivatives by its centre and its ray.
void chain(const Looking& at, const ByVectors& by, std::array<double, 6>& by_pose,
           std::array<double, 3>& by_shared) {
  const MovedCamera& c = at.camera;
  // d ray = ray x turn, d center = turn x (pivot in world axes) - (move in world axes).
  const dvec3 pivot = c.pivot * c.pose.rotation;
  const dvec3 turn = cross(by.ray, at.ray) + cross(pivot, by.center) + by.turn;
  put(by_pose, turn * c.world_turn, -c.move * (c.pose.rotation * by.center));
  const Intrinsics& k = c.intrinsics;
  const dvec3 local = c.pose.rotation * by.ray;
  by_shared[0] -= kFocalUnit * (local.x * at.local.x + local.y * at.local.y);
  by_shared[1] -= local.x / (at.focal * k.fx);
  by_shared[2] += (local.x * k.skew / k.fx - local.y) / (at.focal * k.fy);
}

/// Distance in pixels of the pixel of `self` from the epipolar line of `other`'s.
double distance(const Looking& self, const Looking& other, std::array<double, 6>* by_self,
                std::array<double, 6>* by_other, std::array<double, 3>* by_shared) {
  const Intrinsics& k = self.camera.intrinsics;
  const dmat3& rotation = self.camera.pose.rotation;
  const double f = self.focal;
  const dvec3 base = other.camera.center - self.camera.center;
  const dvec3 plane = cross(base, other.ray), n = rotation * plane;
  const double gx = n.x / (f * k.fx), gy = (n.y - n.x * k.skew / k.fx) / (f * k.fy);
  const double slope = std::sqrt(gx * gx + gy * gy + 1e-300);
  const double d = dot(plane, self.ray) / slope;
  if (!by_self) return d;
  // The slope changes by `steep` with the plane's normal.
  const dvec3 steep_local(gx / (f * k.fx) - gy * k.skew / (f * k.fx * k.fy), gy / (f * k.fy), 0);
  const dvec3 steep = (steep_local / slope) * rotation;
  const dvec3 by_center = (cross(other.ray, self.ray) - d * cross(other.ray, steep)) / slope;
  chain(self, {-by_center, plane / slope, -d / slope * cross(plane, steep)}, *by_self, *by_shared);
  chain(other, {by_center, (cross(self.ray, base) - d * cross(steep, base)) / slope}, *by_other,
        *by_shared);
  (*by_shared)[0] += kFocalUnit * d;
  return d;
}

}  // namespace

Motion::Motion(const Camera& given, const dvec3& world)
    : camera(given), middle(given.to_camera(world)) {
  const double depth = std::max(std::abs(middle.z), 1e-9);
  turn = 4 / camera.intrinsics.fx;
  move = depth / camera.intrinsics.fx;
}

std::array<double, 6> Motion::unknowns_to(const Pose& other) const {
  const Pose& given = camera.cam_from_world;
  const dmat3 r = other.rotation * glm::transpose(given.rotation);
  const dvec3 turned = rotation_vector(r) / turn;
  const dvec3 moved = (other.translation - (r * (given.translation - middle) + middle)) / move;
  return {turned.x, turned.y, turned.z, moved.x, moved.y, moved.z};
}

MovedCamera::MovedCamera(const Motion& motion, const double* u)
    : intrinsics(motion.camera.intrinsics), move(motion.move) {
  const Turn turn = turn_by(motion.turn * dvec3(u[0], u[1], u[2]));
  const Pose& given = motion.camera.cam_from_world;
  pivot = motion.middle + move * dvec3(u[3], u[4], u[5]);
  pose.rotation = turn.rotation * given.rotation;
  pose.translation = turn.rotation * (given.translation - motion.middle) + pivot;
  center = -(pose.translation * pose.rotation);
  turning = motion.turn * turn.left_jacobian;
  world_turn = glm::transpose(pose.rotation) * turning;
}

bool track_residual(const MovedCamera& c, const SharedUnknowns& shared, const dvec3& point,
                    const dvec2& pixel, dvec2& residual, TrackDerivatives* derivatives) {
  const dvec3 p = c.pose.rotation * point + c.pose.translation;
  if (!(p.z > 0)) return false;
  const Intrinsics& k = c.intrinsics;
  const double f = std::exp(shared[0] * kFocalUnit), x = p.x / p.z, y = p.y / p.z;
  const dvec2 image(f * (k.fx * x + k.skew * y), f * k.fy * y);
  residual = image + dvec2(k.cx + shared[1], k.cy + shared[2]) - pixel;
  if (!derivatives) return true;
  const dvec3 rows[2] = {dvec3(f * k.fx, f * k.skew, -image.x) / p.z,
                         dvec3(0, f * k.fy, -image.y) / p.z};
  for (std::size_t i = 0; i < 2; ++i) {
    const dvec3 by_point = rows[i] * c.pose.rotation;
    put(derivatives->by_pose[i], cross(p - c.pivot, rows[i]) * c.turning, c.move * rows[i]);
    derivatives->by_point[i] = {by_point.x, by_point.y, by_point.z};
    derivatives->by_shared[i] = {kFocalUnit * image[int(i)], i == 0 ? 1.0 : 0.0,
                                 i == 1 ? 1.0 : 0.0};
  }
  return true;
}

dvec2 tangent_residual(const MovedCamera& a, const MovedCamera& b, const SharedUnknowns& shared,
                       const FrontierPair& pair, TangentDerivatives* derivatives) {
  const Looking in_a(a, shared, pair.pixel_a), in_b(b, shared, pair.pixel_b);
  if (!derivatives)
    return {distance(in_a, in_b, nullptr, nullptr, nullptr),
            distance(in_b, in_a, nullptr, nullptr, nullptr)};
  TangentDerivatives& by = *derivatives;
  by.by_shared = {};
  return {distance(in_a, in_b, &by.by_pose_a[0], &by.by_pose_b[0], &by.by_shared[0]),
          distance(in_b, in_a, &by.by_pose_b[1], &by.by_pose_a[1], &by.by_shared[1])};
}

}  // namespace photohull
