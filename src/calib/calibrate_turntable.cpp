// One fixed camera, and a board that turns: all views share an axis.
#include <algorithm>
#include <glm/gtc/quaternion.hpp>

#include "calib/board_model.h"
#include "calib/object_error.h"
#include "core/error.h"
#include "core/median.h"
#include "core/option_word.h"

namespace photohull {
namespace {

/// An axis near a given one: two angles and two lengths across it.
struct Axis {
  glm::dvec3 direction, point, x, y;

  Axis(const glm::dvec3& d, const glm::dvec3& p) : direction(d), point(p) {
    x = glm::normalize(
        glm::cross(d, std::abs(d.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    y = glm::cross(d, x);
  }

  template <typename T>
  void at(const T* change, T* d, T* p) const {
    using std::sqrt;
    T squared = T(0);
    for (int i = 0; i < 3; ++i) {
      d[i] = direction[i] + change[0] * x[i] + change[1] * y[i];
      p[i] = point[i] + change[2] * x[i] + change[3] * y[i];
      squared += d[i] * d[i];
    }
    for (int i = 0; i < 3; ++i) d[i] /= sqrt(squared);
  }
};

/// The board where the table stands at angle 0, turned about the axis.
struct TurntableResidual {
  LensModel model;
  const Axis& axis;
  glm::dvec3 point;
  glm::dvec2 pixel;

  template <typename T>
  bool operator()(const T* lens, const T* board, const T* change, const T* angle,
                  T* residual) const {
    T p[3], d[3], c[3], q[3];
    to_camera(board, point, p);
    axis.at(change, d, c);
    for (int i = 0; i < 3; ++i) p[i] -= c[i], d[i] *= angle[0];
    ceres::AngleAxisRotatePoint(d, p, q);
    for (int i = 0; i < 3; ++i) q[i] += c[i];
    if (!(q[2] > 0.0)) return false;
    project(model, lens, q, residual);
    residual[0] -= pixel.x, residual[1] -= pixel.y;
    return true;
  }
};

glm::dmat3 turn_about(const glm::dvec3& axis, double radians) {
  return glm::mat3_cast(glm::angleAxis(radians, axis));
}

glm::dvec3 rotation_vector(const glm::dmat3& r) {
  const Rigid turn = rigid_of({r, {}});
  return {turn[0], turn[1], turn[2]};
}

class Turntable {
 public:
  Turntable(SingleCamera& camera, const std::vector<double>& degrees) : c_(camera) {
    for (const double angle : degrees) given_.push_back(angle / kDegreesPerRadian);
  }

  TurntableAxis run() {
    if (c_.used.size() < kFewestBoardViews)
      throw Error(concat("the board was found in ", c_.used.size(),
                         " pictures, but a turntable needs three"));
    free_rms_ = median_rms();
    for (;;) {
      solve_once();
      if (!drop_outliers()) break;
    }
    if (!given_.empty()) check_given();
    return table_;
  }

 private:
  double median_rms() const {
    const std::vector<double> all = c_.rms();
    std::vector<double> rms;
    for (const std::size_t i : c_.used) rms.push_back(all[i]);
    return median(rms);
  }

  /// Turns of the first view used into each.
  std::vector<glm::dmat3> turns() const {
    const glm::dmat3 first = rotation_of(c_.poses[c_.used[0]]);
    std::vector<glm::dmat3> r;
    for (const std::size_t i : c_.used)
      r.push_back(rotation_of(c_.poses[i]) * glm::transpose(first));
    return r;
  }

  /// The sum of the turns' vectors, each weighed by how well it tells the axis.
  glm::dvec3 guess_direction(const std::vector<glm::dmat3>& turns) const {
    glm::dvec3 sum(0.0);
    for (std::size_t n = 0; n < turns.size(); ++n) {
      const glm::dmat3& r = turns[n];
      if (given_.empty()) {
        const glm::dvec3 v = rotation_vector(r);
        sum += glm::dot(v, sum) < 0 ? -v : v;
      } else {  // the part of r that is odd in the angle: sin(angle) times the axis
        const double sine = std::sin(given_[c_.used[n]] - given_[c_.used[0]]);
        sum += 0.5 * sine * glm::dvec3(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
      }
    }
    if (!(glm::length(sum) > (given_.empty() ? 0.02 : 1e-4)))
      throw Error("the board does not turn between the pictures; is this a turntable?");
    return glm::normalize(sum);
  }

  /// A point of the axis: c = R c + (t - R t0), by least squares over the views.
  glm::dvec3 guess_point(const std::vector<glm::dmat3>& turns, const glm::dvec3& axis) const {
    const glm::dvec3 t0 = pose_of(c_.poses[c_.used[0]]).translation;
    glm::dmat3 normal = glm::outerProduct(axis, axis);
    glm::dvec3 right(0.0);  // of the axis' points the one nearest to the camera
    for (std::size_t n = 0; n < turns.size(); ++n) {
      const glm::dmat3 a = glm::dmat3(1.0) - turns[n];
      normal += glm::transpose(a) * a;
      right += glm::transpose(a) * (pose_of(c_.poses[c_.used[n]]).translation - turns[n] * t0);
    }
    return glm::inverse(normal) * right;
  }

  static bool mostly_falling(const std::vector<double>& angles) {
    int rising = 0;
    for (std::size_t n = 1; n < angles.size(); ++n) {
      const double step = std::remainder(angles[n] - angles[n - 1], 2 * std::numbers::pi);
      rising += step < 0 ? -1 : 1;
    }
    return rising < 0;
  }

  void solve_once() {
    const std::vector<glm::dmat3> r = turns();
    glm::dvec3 direction = guess_direction(r);
    const std::size_t count = c_.used.size();
    std::vector<double> angles(count);
    for (std::size_t n = 0; n < count; ++n)
      angles[n] = given_.empty() ? glm::dot(rotation_vector(r[n]), direction) : given_[c_.used[n]];
    if (given_.empty() && mostly_falling(angles)) {
      direction = -direction;
      for (double& angle : angles) angle = -angle;
    }
    const Axis axis(direction, guess_point(r, direction));
    // The board as it stands at angle 0.
    const Pose first = pose_of(c_.poses[c_.used[0]]);
    const glm::dmat3 back = turn_about(direction, -angles[0]);
    Rigid board =
        rigid_of({back * first.rotation, back * (first.translation - axis.point) + axis.point});
    std::array<double, 4> change{};
    ceres::Problem problem;
    for (std::size_t n = 0; n < count; ++n) {
      const BoardView& view = c_.views[c_.used[n]];
      for (std::size_t k = 0; k < view.points.size(); ++k)
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<TurntableResidual, 2, 12, 6, 4, 1>(
                new TurntableResidual{c_.model, axis, view.points[k], view.pixels[k]}),
            new ceres::HuberLoss(1), c_.lens.data(), board.data(), change.data(), &angles[n]);
      if (n == 0 || !given_.empty()) problem.SetParameterBlockConstant(&angles[n]);
    }
    hold_lens(problem, c_.model, c_.lens_known, c_.lens);
    solve(problem);
    report(problem, axis, board, change, angles);
    for (std::size_t n = 0; n < count; ++n) {
      const glm::dmat3 turn = turn_about(table_.direction, angles[n]);
      const Pose pose = pose_of(board);
      c_.poses[c_.used[n]] =
          rigid_of({turn * pose.rotation, turn * (pose.translation - table_.point) + table_.point});
    }
  }

  void report(ceres::Problem& problem, const Axis& axis, Rigid& board,
              std::array<double, 4>& change, std::vector<double>& angles) {
    table_ = {};
    table_.angles_given = !given_.empty();
    axis.at(change.data(), &table_.direction.x, &table_.point.x);
    table_.angles.assign(c_.views.size(), NAN);
    for (std::size_t n = 0; n < angles.size(); ++n)
      table_.angles[c_.used[n]] = angles[n] * kDegreesPerRadian;
    const StandardDeviations sigmas(problem);
    c_.note_sigma(sigmas.of(c_.lens.data()));
    ObjectError error(problem, sigmas);
    const glm::ivec2 frame = c_.views[c_.used[0]].size();
    for (const glm::dvec3& point : points_around_board(c_))
      for (double& angle : angles)
        error.add<TurntableResidual, 12, 6, 4, 1>(frame, {c_.model, axis, point, {}},
                                                  c_.lens.data(), board.data(), change.data(),
                                                  &angle);
    c_.object_error = error.rms();
    const std::vector<double> sigma = sigmas.of(change.data());
    if (sigma.empty()) return;
    table_.direction_sigma = kDegreesPerRadian * std::max(sigma[0], sigma[1]);
    table_.point_sigma = std::max(sigma[2], sigma[3]);
    for (const double& angle : angles)
      for (const double s : sigmas.of(&angle))
        table_.angle_sigma = std::max(table_.angle_sigma, kDegreesPerRadian * s);
  }

  /// The worst view goes while it is far worse than the others; true where one went.
  bool drop_outliers() {
    const std::vector<double> all = c_.rms();
    std::vector<double> rms;
    for (const std::size_t i : c_.used) rms.push_back(all[i]);
    const auto worst = std::max_element(rms.begin(), rms.end());
    if (*worst <= outlier_limit(rms) || rms.size() <= kFewestBoardViews) return false;
    c_.used.erase(c_.used.begin() + (worst - rms.begin()));
    return true;
  }

  /// Angles that are wrong throughout show in all views.
  void check_given() const {
    constexpr double kFarOff = 5;  // times what poses without a common axis leave
    const double rms = median_rms();
    if (rms > std::max(1.0, kFarOff * free_rms_))
      throw Error(concat("the stated angles do not fit the pictures: ", rms,
                         " px rms (median view), and ", free_rms_, " px without them; check ",
                         option_word("step"), " or ", option_word("angles"),
                         " and the order of the pictures, or let the angles be found"));
  }

  SingleCamera& c_;
  std::vector<double> given_;  ///< radians, of each view
  double free_rms_ = 0;        ///< pixels, of the median view with a pose of its own
  TurntableAxis table_;
};

}  // namespace

TurntableAxis refine_turntable(SingleCamera& camera, const std::vector<double>& angles) {
  return Turntable(camera, angles).run();
}

}  // namespace photohull
