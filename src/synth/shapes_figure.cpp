// A figure that dances on one leg: the smooth union of limbs, whose pose hangs on a phase.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/error.h"
#include "synth/field_mesh.h"
#include "synth/shape_makers.h"

namespace photohull::synth {
namespace {

// It looks along -y, its left is +x, up is +z, and lengths are those of a figure two units high.
constexpr double kBlend = 0.02;  ///< how softly limbs join
constexpr double kBone = 0.44;   ///< thigh and shin
constexpr double kPlinthRadius = 0.4, kPlinthHeight = 0.15, kPlinthEdge = 0.05;
constexpr std::size_t kMostLimbs = 24;
constexpr double kLeft = 1, kRight = -1;

/// A ball swept along a straight line while its radius changes, in space that is stretched along
/// the axes of a frame, so that sections may be ellipses.
class Limb {
 public:
  Limb(const glm::dvec3& from, const glm::dvec3& to, double first, double last,
       const glm::dmat3& axes = glm::dmat3(1.0), const glm::dvec3& stretch = glm::dvec3(1.0))
      : into_(glm::dmat3({stretch.x, 0, 0}, {0, stretch.y, 0}, {0, 0, stretch.z}) *
              transpose(axes)),
        from_(from),
        radius_(first),
        scale_(1 / std::max({stretch.x, stretch.y, stretch.z})) {
    const glm::dvec3 along = into_ * (to - from);
    length_ = glm::length(along);
    axis_ = length_ > 0 ? along / length_ : glm::dvec3(0, 0, 1);
    slope_ = length_ > 0 ? (first - last) / length_ : 0;
    shear_ = slope_ / std::sqrt(1 - slope_ * slope_);
  }

  /// The distance where nothing is stretched, else a lower bound of it; it changes no faster than
  /// distances do.
  double distance(const glm::dvec3& p) const {
    const glm::dvec3 q = into_ * (p - from_);
    const double along = dot(q, axis_), aside = glm::length(q - along * axis_);
    const double nearest = std::clamp(along - aside * shear_, 0.0, length_);  // the ball's middle
    const double past = along - nearest;
    return scale_ * (std::sqrt(past * past + aside * aside) - (radius_ - nearest * slope_));
  }

 private:
  glm::dmat3 into_;
  glm::dvec3 from_, axis_{0.0};
  double radius_, scale_, length_ = 0;
  double slope_ = 0, shear_ = 0;  ///< sine and tangent of half the cone's angle
};

/// Distance to the disc that it stands on, its edges rounded.
double plinth_distance(const glm::dvec3& p) {
  const double out = std::hypot(p.x, p.y) - (kPlinthRadius - kPlinthEdge);
  const double up = std::abs(p.z - kPlinthHeight / 2) - (kPlinthHeight / 2 - kPlinthEdge);
  return std::hypot(std::max(out, 0.0), std::max(up, 0.0)) + std::min(std::max(out, up), 0.0) -
         kPlinthEdge;
}

glm::dmat3 turn_about(int axis, double degrees) {
  const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
  if (axis == 0) return {1, 0, 0, 0, c, s, 0, -s, c};
  if (axis == 1) return {c, 0, -s, 0, 1, 0, s, 0, c};
  return {c, s, 0, -s, c, 0, 0, 0, 1};
}

/// Unit vector of what hangs down, swung forward and then out to its side, degrees.
glm::dvec3 hanging(double forward, double out, double side) {
  const double a = glm::radians(forward), b = glm::radians(out);
  return {side * std::sin(b), -std::cos(b) * std::sin(a), -std::cos(b) * std::cos(a)};
}

/// Outside of all parts where it is zero, and so without a kink there.
double smooth_union(std::span<const double> distances) {
  const double least = *std::min_element(distances.begin(), distances.end());
  double sum = 0;
  for (const double distance : distances) {
    const double apart = (distance - least) / kBlend;
    if (apart < 25) sum += std::exp(-apart);  // less is nothing beside 1
  }
  return least - kBlend * std::log(sum);
}

/// All limbs in the pose of a phase.
class Figure {
 public:
  explicit Figure(const ShapeValues& v)
      : swing_(v.at("swing")),
        sine_(std::sin(2 * std::numbers::pi * v.at("phase"))),
        cosine_(std::cos(2 * std::numbers::pi * v.at("phase"))),
        pelvis_(0.0004 * swing_ * cosine_, 0, 1.135 - 0.0004 * swing_ * (1 - cosine_)),
        trunk_(turn_about(2, -0.35 * swing_ * sine_) * turn_about(1, 0.08 * swing_ * cosine_) *
               turn_about(0, 3 + 0.12 * swing_ * (1 - cosine_))) {
    add_standing_leg();
    add_free_leg();
    add_trunk();
    for (const double side : {kLeft, kRight}) add_arm(side);
    PHOTOHULL_CHECK(limbs_.size() <= kMostLimbs);
  }

  /// The plinth joins what stands on it alone, so that no other limb moves its surface; where the
  /// two unions are alike, far from plinth and hip, one goes over into the other.
  double field(const glm::dvec3& p) const {
    std::array<double, kMostLimbs> distances{};
    for (std::size_t i = 0; i < limbs_.size(); ++i) distances[i] = limbs_[i].distance(p);
    const std::array<double, 3> below = {distances[0], distances[1], plinth_distance(p)};
    return std::min(smooth_union(below), smooth_union({distances.data(), limbs_.size()}));
  }

 private:
  /// A point of the trunk's frame, whose origin is the pelvis.
  glm::dvec3 on_trunk(double x, double y, double z) const {
    return pelvis_ + trunk_ * glm::dvec3(x, y, z);
  }

  void add(const glm::dvec3& from, const glm::dvec3& to, double first, double last) {
    limbs_.push_back(Limb(from, to, first, last));
  }

  void add_trunk() {
    const glm::dvec3 flat(1, 1.35, 1);  // deep as 1 is to 1.35 of their width
    const glm::dvec3 hip(0.065, 0, 0);
    limbs_.push_back(Limb(pelvis_ - hip, pelvis_ + hip, 0.115, 0.115, glm::dmat3(1.0), flat));
    limbs_.push_back(Limb(on_trunk(0, 0, 0.04), on_trunk(0, 0, 0.32), 0.115, 0.155, trunk_, flat));
    add(on_trunk(-0.155, 0, 0.42), on_trunk(0.155, 0, 0.42), 0.062, 0.062);
    add(on_trunk(0, 0, 0.45), on_trunk(0, -0.01, 0.58), 0.055, 0.052);
    // The head turns back a little to where the figure looks, and has a nose.
    const glm::dmat3 head = trunk_ * turn_about(2, 0.2 * swing_ * sine_);
    const glm::dvec3 middle = on_trunk(0, -0.02, 0.69);
    limbs_.push_back(Limb(middle, middle, 0.095, 0.095, head, {1, 0.88, 0.74}));
    add(middle + head * glm::dvec3(0, -0.08, 0), middle + head * glm::dvec3(0, -0.1, -0.025), 0.04,
        0.042);
  }

  /// The left arm swings forward as the free leg does, the right one against it.
  void add_arm(double side) {
    const double swung = side * swing_ * sine_;
    const double forward = 5 + swung, bent = 45 + 0.6 * swung;
    const glm::dvec3 shoulder = on_trunk(side * 0.195, 0, 0.42);
    const glm::dvec3 elbow = shoulder + 0.29 * (trunk_ * hanging(forward, 30, side));
    const glm::dvec3 lower = trunk_ * hanging(forward + bent, 14, side);
    const glm::dvec3 wrist = elbow + 0.25 * lower;
    add(shoulder, elbow, 0.064, 0.053);
    add(elbow, wrist, 0.053, 0.048);
    add(wrist + 0.03 * lower, wrist + 0.08 * lower, 0.058, 0.052);
  }

  /// Its foot is fixed on the plinth, and its knee bends as the pelvis asks for. Foot and shin come
  /// first.
  void add_standing_leg() {
    const glm::dvec3 hip = pelvis_ + glm::dvec3(0.115, 0, -0.035), ankle(0.07, 0.04, 0.25);
    const double apart = glm::length(ankle - hip);
    const glm::dvec3 down = (ankle - hip) / apart;
    const glm::dvec3 ahead = normalize(glm::dvec3(0, -1, 0) + down.y * down);
    const double out = std::sqrt(std::max(0.0, kBone * kBone - apart * apart / 4));
    const glm::dvec3 knee = 0.5 * (hip + ankle) + out * ahead;
    add({0.07, 0.075, 0.205}, {0.09, -0.13, 0.195}, 0.055, 0.052);
    add(knee, ankle, 0.06, 0.047);
    add(hip, knee, 0.088, 0.063);
  }

  void add_free_leg() {
    const double forward = 20 + swing_ * sine_, back = forward - (75 - 0.5 * swing_ * sine_);
    const glm::dvec3 hip = pelvis_ + glm::dvec3(-0.115, 0, -0.015);
    const glm::dvec3 knee = hip + kBone * hanging(forward, 9, kRight);
    const glm::dvec3 ankle = knee + kBone * hanging(back, 3, kRight);
    // The foot stands across the shin, toes up by 25 degrees.
    const glm::dvec3 toes = hanging(back + 115, 3, kRight), sole = hanging(back + 25, 3, kRight);
    add(hip, knee, 0.088, 0.063);
    add(knee, ankle, 0.06, 0.047);
    add(ankle - 0.04 * toes + 0.035 * sole, ankle + 0.16 * toes + 0.04 * sole, 0.055, 0.052);
  }

  double swing_, sine_, cosine_;
  glm::dvec3 pelvis_;
  glm::dmat3 trunk_;  ///< world_from_trunk
  std::vector<Limb> limbs_;
};

}  // namespace

double figure_field(const glm::dvec3& p, const ShapeValues& v) { return Figure(v).field(p); }

TriMesh make_figure(const ShapeValues& v) {
  // The same lattice around all poses, so that what stands still has the same triangles in all.
  GridSpec grid;
  grid.voxel_size = 0.005;
  const glm::dvec3 low(-0.8, -1.2, -0.03), high(0.8, 0.9, 2.15);
  grid.bricks = glm::ivec3(ceil((high - low) / (grid.voxel_size * kBrickEdge)));
  grid.origin = low;
  const Figure figure(v);
  return mesh_of_distance([&](const glm::dvec3& p) { return figure.field(p); }, grid);
}

}  // namespace photohull::synth
