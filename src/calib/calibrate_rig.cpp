// Based on: B. Triggs et al., "Bundle adjustment: a modern synthesis", 1999 [Triggs99].
#include "calib/calibrate_rig.h"

#include <algorithm>
#include <limits>

#include "calib/board_model.h"
#include "calib/object_error.h"
#include "core/error.h"
#include "core/median.h"

namespace photohull {
namespace {

Pose operator*(const Pose& a, const Pose& b) {
  return {a.rotation * b.rotation, a.rotation * b.translation + a.translation};
}

Pose inverse(const Pose& p) {
  const glm::dmat3 r = glm::transpose(p.rotation);
  return {r, -(r * p.translation)};
}

/// A board's point through its pose in the rig and the rig's in a camera.
struct RigResidual {
  LensModel model;
  glm::dvec3 point;
  glm::dvec2 pixel;

  template <typename T>
  bool operator()(const T* lens, const T* camera, const T* board, T* residual) const {
    T p[3], q[3];
    to_camera(board, point, p);
    ceres::AngleAxisRotatePoint(camera, p, q);
    for (int i = 0; i < 3; ++i) q[i] += camera[3 + i];
    if (!(q[2] > 0.0)) return false;
    project(model, lens, q, residual);
    residual[0] -= pixel.x, residual[1] -= pixel.y;
    return true;
  }
};

class RigCalibrator {
 public:
  RigCalibrator(const std::vector<RigCameraViews>& given, LensModel lens)
      : given_(given), moments_(given[0].views.size()) {
    for (const RigCameraViews& camera : given_) {
      PHOTOHULL_CHECK_OP(camera.views.size(), ==, moments_);
      try {
        cameras_.push_back(calibrate_camera(camera.views, lens, camera.known));
      } catch (const UsageError&) {
        throw;
      } catch (const Error& failure) {
        throw Error(concat("camera ", camera.name, ": ", failure.what()));
      }
      used_.emplace_back(moments_, false);
      for (const std::size_t m : cameras_.back().used) used_.back()[m] = true;
    }
  }

  RigCalibration run() {
    connect();
    place_boards();
    do {
      refine();
    } while (drop_outliers());
    return result();
  }

 private:
  std::size_t count() const { return cameras_.size(); }

  double rms_at(std::size_t camera, std::size_t moment, const Pose& rig_from_board) const {
    const SingleCamera& c = cameras_[camera];
    return view_rms(c.views[moment], c.model, c.lens,
                    rigid_of(pose_of(rig_[camera]) * rig_from_board));
  }

  /// The pose of b relative to a that suits most of the moments that both see.
  Pose between(std::size_t a, std::size_t b) const {
    std::vector<Pose> candidates;
    std::vector<std::size_t> shared;
    for (std::size_t m = 0; m < moments_; ++m)
      if (used_[a][m] && used_[b][m]) {
        shared.push_back(m);
        candidates.push_back(pose_of(cameras_[b].poses[m]) *
                             inverse(pose_of(cameras_[a].poses[m])));
      }
    Pose best;
    double least = std::numeric_limits<double>::infinity();
    for (const Pose& b_from_a : candidates) {
      std::vector<double> rms;
      for (const std::size_t m : shared)
        rms.push_back(view_rms(cameras_[b].views[m], cameras_[b].model, cameras_[b].lens,
                               rigid_of(b_from_a * pose_of(cameras_[a].poses[m]))));
      const double middle = median(rms);
      if (middle < least) least = middle, best = b_from_a;
    }
    return best;
  }

  /// Cameras relative to the first, along a tree of those that share most moments.
  void connect() {
    rig_.assign(count(), Rigid{});
    std::vector<bool> known(count(), false);
    known[0] = true;
    for (std::size_t step = 1; step < count(); ++step) {
      std::size_t from = 0, to = 0, most = 0;
      for (std::size_t a = 0; a < count(); ++a)
        for (std::size_t b = 0; b < count(); ++b) {
          if (!known[a] || known[b]) continue;
          std::size_t shared = 0;
          for (std::size_t m = 0; m < moments_; ++m) shared += used_[a][m] && used_[b][m];
          if (shared > most) most = shared, from = a, to = b;
        }
      if (most == 0) {
        const auto lost = std::find(known.begin(), known.end(), false) - known.begin();
        throw Error(concat("camera ", given_[std::size_t(lost)].name,
                           " never sees the board at the same moment as ", given_[0].name,
                           " or a camera that is connected to it; photograph the board where both "
                           "see it, and check how moments are named"));
      }
      rig_[to] = rigid_of(between(from, to) * pose_of(rig_[from]));
      known[to] = true;
    }
  }

  /// The board at each moment, by the camera whose own pose suits the others best.
  void place_boards() {
    boards_.assign(moments_, Rigid{});
    for (std::size_t m = 0; m < moments_; ++m) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t c = 0; c < count(); ++c) {
        if (!used_[c][m]) continue;
        const Pose board = inverse(pose_of(rig_[c])) * pose_of(cameras_[c].poses[m]);
        std::vector<double> rms;
        for (std::size_t other = 0; other < count(); ++other)
          if (used_[other][m]) rms.push_back(rms_at(other, m, board));
        const double middle = median(rms);
        if (middle < least) least = middle, boards_[m] = rigid_of(board);
      }
    }
  }

  void refine() {
    ceres::Problem problem;
    std::vector<double*> boards;
    for (std::size_t m = 0; m < moments_; ++m)
      for (std::size_t c = 0; c < count(); ++c) {
        if (!used_[c][m]) continue;
        const BoardView& view = cameras_[c].views[m];
        for (std::size_t k = 0; k < view.points.size(); ++k)
          problem.AddResidualBlock(
              new ceres::AutoDiffCostFunction<RigResidual, 2, 12, 6, 6>(
                  new RigResidual{cameras_[c].model, view.points[k], view.pixels[k]}),
              new ceres::HuberLoss(1), cameras_[c].lens.data(), rig_[c].data(), boards_[m].data());
        if (boards.empty() || boards.back() != boards_[m].data())
          boards.push_back(boards_[m].data());
      }
    for (SingleCamera& c : cameras_)
      if (problem.HasParameterBlock(c.lens.data()))
        hold_lens(problem, c.model, c.lens_known, c.lens);
    if (problem.HasParameterBlock(rig_[0].data()))
      problem.SetParameterBlockConstant(rig_[0].data());
    solve(problem, boards);
    note_sigmas(problem);
  }

  void note_sigmas(ceres::Problem& problem) {
    const StandardDeviations sigmas(problem);
    sigmas_.assign(count(), {});
    for (std::size_t c = 0; c < count(); ++c) {
      cameras_[c].note_sigma(sigmas.of(cameras_[c].lens.data()));
      sigmas_[c] = sigmas.of(rig_[c].data());
    }
    object_error_ = object_error(problem, sigmas);
  }

  /// Over places of the room in which the boards were held.
  double object_error(ceres::Problem& problem, const StandardDeviations& sigmas) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (std::size_t m = 0; m < moments_; ++m)
      for (std::size_t c = 0; c < count(); ++c) {
        if (!used_[c][m]) continue;
        const Pose board = pose_of(boards_[m]);
        for (const glm::dvec3& p : cameras_[c].views[m].points) {
          const glm::dvec3 q = board.rotation * p + board.translation;
          low = glm::min(low, q), high = glm::max(high, q);
        }
      }
    ObjectError error(problem, sigmas);
    for (std::size_t c = 0; c < count(); ++c) {
      SingleCamera& camera = cameras_[c];
      for (const glm::dvec3& point : points_throughout(low, high))
        error.add<BoardResidual, 12, 6>(camera.views[camera.used[0]].size(),
                                        {camera.model, point, {}}, camera.lens.data(),
                                        rig_[c].data());
    }
    return error.rms();
  }

  /// Of each moment the view that fits worst goes where it is far worse than the others; true where
  /// one went. What is left of the moment is judged again after the next refinement.
  bool drop_outliers() {
    std::vector<double> all;
    std::vector<std::vector<double>> rms(count(), std::vector<double>(moments_, 0.0));
    for (std::size_t c = 0; c < count(); ++c)
      for (std::size_t m = 0; m < moments_; ++m)
        if (used_[c][m]) all.push_back(rms[c][m] = rms_at(c, m, pose_of(boards_[m])));
    const double limit = outlier_limit(all);
    bool dropped = false;
    for (std::size_t m = 0; m < moments_; ++m) {
      std::size_t worst = 0;
      for (std::size_t c = 1; c < count(); ++c)
        if (rms[c][m] > rms[worst][m]) worst = c;
      if (rms[worst][m] <= limit) continue;
      used_[worst][m] = false;
      dropped = true;
    }
    if (dropped) check_left();
    return dropped;
  }

  /// What is left must still determine every camera and connect it.
  void check_left() {
    for (std::size_t c = 0; c < count(); ++c) {
      const auto left = std::size_t(std::count(used_[c].begin(), used_[c].end(), true));
      if (left < cameras_[c].fewest_views())
        throw Error(concat("camera ", given_[c].name, ": only ", left,
                           " of its views fit the other cameras'; were the pictures of a moment "
                           "taken at the same time?"));
    }
    const std::vector<Rigid> before = rig_;
    connect();  // throws where a camera has lost its connection
    rig_ = before;
  }

  RigCalibration result() const {
    RigCalibration r;
    double all = 0, all_count = 0;
    for (std::size_t c = 0; c < count(); ++c) {
      const SingleCamera& single = cameras_[c];
      RigCamera camera;
      camera.name = given_[c].name;
      const BoardView& first = given_[c].views[single.used[0]];
      set_lens(single.lens, single.model, first.width, first.height, camera.intrinsics,
               camera.distortion);
      camera.cam_from_rig = pose_of(rig_[c]);
      double sum = 0, points = 0;
      for (std::size_t m = 0; m < moments_; ++m) {
        const bool found = single.views[m].points.size() >= kFewestBoardPoints;
        // A moment that no other camera vouches for is judged by the camera's own pose.
        camera.rms.push_back(!found     ? NAN
                             : known(m) ? rms_at(c, m, pose_of(boards_[m]))
                                        : single.rms()[m]);
        camera.left_out.push_back(!used_[c][m]);
        if (!used_[c][m]) continue;
        const double n = double(single.views[m].points.size());
        sum += camera.rms[m] * camera.rms[m] * n;
        points += n;
      }
      camera.all_rms = std::sqrt(sum / points);
      camera.focal_sigma = single.focal_sigma;
      camera.principal_sigma = single.principal_sigma;
      camera.model = single.model;
      camera.lens_known = single.lens_known;
      if (!sigmas_[c].empty()) {
        const auto s = sigmas_[c].begin();
        camera.rotation_sigma = kDegreesPerRadian * *std::max_element(s, s + 3);
        camera.translation_sigma = *std::max_element(s + 3, s + 6);
      }
      all += sum, all_count += points;
      r.cameras.push_back(camera);
    }
    for (std::size_t m = 0; m < moments_; ++m)
      r.rig_from_board.push_back(known(m) ? pose_of(boards_[m]) : Pose{});
    r.all_rms = std::sqrt(all / all_count);
    r.object_error = object_error_;
    return r;
  }

  bool known(std::size_t moment) const {
    return std::any_of(used_.begin(), used_.end(), [&](const auto& u) { return bool(u[moment]); });
  }

  const std::vector<RigCameraViews>& given_;
  std::size_t moments_;
  std::vector<SingleCamera> cameras_;
  std::vector<std::vector<bool>> used_;  ///< [camera][moment]
  std::vector<Rigid> rig_;               ///< of each camera: from the rig's frame
  std::vector<Rigid> boards_;            ///< of each moment: to the rig's frame
  std::vector<std::vector<double>> sigmas_;
  double object_error_ = 0;
};

}  // namespace

RigCalibration calibrate_rig(const std::vector<RigCameraViews>& cameras, LensModel lens) {
  if (cameras.size() < 2)
    throw UsageError(concat("a rig has two cameras or more; ", cameras.size(), " found"));
  return RigCalibrator(cameras, lens).run();
}

}  // namespace photohull
