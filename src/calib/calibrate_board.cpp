#include "calib/calibrate_board.h"

#include <algorithm>
#include <array>

#include "calib/board_model.h"
#include "calib/object_error.h"
#include "core/error.h"
#include "core/option_word.h"

namespace photohull {
namespace {

class Calibrator {
 public:
  Calibrator(const std::vector<BoardView>& views, LensModel model,
             const std::optional<KnownLens>& known)
      : measured_(views) {
    c_.model = known ? model_of(known->distortion) : model;
    c_.lens_known = known.has_value();
    if (known) c_.lens = lens_of(*known);
    c_.views = views;
    c_.poses.resize(views.size());
  }

  SingleCamera run() {
    for (std::size_t i = 0; i < measured_.size(); ++i)
      if (measured_[i].points.size() >= kFewestBoardPoints) c_.used.push_back(i);
    if (c_.used.size() < c_.fewest_views())
      throw Error(concat("the board was found in ", c_.used.size(), " of ", measured_.size(),
                         " pictures, but ", c_.lens_known ? "one is" : "three are",
                         " needed; check ", option_word("board"), ", ", option_word("columns"),
                         " and ", option_word("rows")));
    check_same_size(measured_, c_.used);
    start();
    drop_outliers();
    refine();
    for (int round = 0; round < 3 && correct_dots(); ++round) refine();
    return std::move(c_);
  }

 private:
  void start() {
    if (c_.lens_known) {
      c_.poses = start_poses(c_.views, c_.used, c_.model, c_.lens);
      return;
    }
    const BoardStart found = start_calibration(c_.views, c_.used, c_.model);
    c_.lens = found.lens;
    for (const std::size_t i : c_.used) c_.poses[i] = found.poses[i];
  }

  /// Leaves out views that are three times as far off as the median one, and calibrates again,
  /// until there are no more of them.
  void drop_outliers() {
    for (;;) {
      const std::vector<double> all = c_.rms();
      std::vector<double> rms;
      for (const std::size_t i : c_.used) rms.push_back(all[i]);
      const double limit = outlier_limit(rms);
      std::vector<std::size_t> kept;
      for (const std::size_t i : c_.used)
        if (all[i] <= limit) kept.push_back(i);
      if (kept.size() == c_.used.size() || kept.size() < c_.fewest_views()) return;
      c_.used = kept;
      start();
    }
  }

  void refine() {
    ceres::Problem problem;
    std::vector<double*> poses;
    for (const std::size_t i : c_.used) {
      poses.push_back(c_.poses[i].data());
      for (std::size_t k = 0; k < c_.views[i].points.size(); ++k)
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<BoardResidual, 2, 12, 6>(
                new BoardResidual{c_.model, c_.views[i].points[k], c_.views[i].pixels[k]}),
            new ceres::HuberLoss(1), c_.lens.data(), c_.poses[i].data());
    }
    hold_lens(problem, c_.model, c_.lens_known, c_.lens);
    solve(problem, poses);
    const StandardDeviations sigmas(problem);
    c_.note_sigma(sigmas.of(c_.lens.data()));
    ObjectError error(problem, sigmas);
    const glm::ivec2 frame = c_.views[c_.used[0]].size();
    for (const glm::dvec3& point : points_around_board(c_))
      for (const std::size_t i : c_.used)
        error.add<BoardResidual, 12, 6>(frame, {c_.model, point, {}}, c_.lens.data(),
                                        c_.poses[i].data());
    c_.object_error = error.rms();
  }

  /// False where there are no dots.
  bool correct_dots() {
    bool any = false;
    for (const std::size_t i : c_.used) {
      BoardView& view = c_.views[i];
      if (!(view.dot_radius > 0)) continue;
      any = true;
      for (std::size_t k = 0; k < view.points.size(); ++k)
        view.pixels[k] = measured_[i].pixels[k] -
                         dot_bias(c_.model, c_.lens, c_.poses[i], view.points[k], view.dot_radius);
    }
    return any;
  }

  const std::vector<BoardView>& measured_;
  SingleCamera c_;
};

}  // namespace

const char* to_string(LensModel model) {
  switch (model) {
    case LensModel::kPinhole:
      return "pinhole";
    case LensModel::kBrown:
      return "brown";
    case LensModel::kRational:
      return "rational";
    case LensModel::kFisheye:
      return "fisheye";
  }
  return "?";
}

void describe(Described& to, CalibrateOptions& o) {
  to.choice(
      "lens", &o.lens,
      std::array{LensModel::kPinhole, LensModel::kBrown, LensModel::kRational, LensModel::kFisheye},
      "which distortion is found");
  to.flag("turntable", &o.turntable,
          "a fixed camera and a board that turns: find their common axis and the angles");
}

void CalibrateOptions::validate(std::size_t views) const {
  if (angles.empty()) return;
  if (!turntable)
    throw UsageError(concat("angles are stated, but ", option_word("turntable"), " is not"));
  if (angles.size() != views)
    throw UsageError(concat(angles.size(), " angles are stated for ", views,
                            " pictures; give one for each, in the order of their names"));
  for (const double angle : angles)
    if (!(std::abs(angle) < 1e6))
      throw UsageError(concat("the angle ", angle, ": expected degrees"));
}

std::vector<double> SingleCamera::rms() const {
  std::vector<double> result(views.size(), NAN);
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].points.size() >= kFewestBoardPoints)
      result[i] = view_rms(views[i], model, lens, poses[i]);
  return result;
}

void SingleCamera::note_sigma(const std::vector<double>& lens_sigma) {
  if (lens_sigma.empty()) return;
  focal_sigma = std::max(lens_sigma[0], lens_sigma[1]);
  principal_sigma = std::max(lens_sigma[2], lens_sigma[3]);
}

SingleCamera calibrate_camera(const std::vector<BoardView>& views, LensModel model,
                              const std::optional<KnownLens>& known) {
  return Calibrator(views, model, known).run();
}

Calibration calibrate(const std::vector<BoardView>& views, const CalibrateOptions& options) {
  options.validate(views.size());
  SingleCamera camera = calibrate_camera(views, options.lens, options.known);
  Calibration c;
  if (options.turntable) c.turntable = refine_turntable(camera, options.angles);
  const BoardView& first = views[camera.used[0]];
  set_lens(camera.lens, camera.model, first.width, first.height, c.intrinsics, c.distortion);
  c.rms = camera.rms();
  c.left_out.assign(views.size(), true);
  c.cam_from_board.resize(views.size());
  double sum = 0, count = 0;
  for (const std::size_t i : camera.used) {
    c.left_out[i] = false;
    c.cam_from_board[i] = pose_of(camera.poses[i]);
    sum += c.rms[i] * c.rms[i] * double(views[i].points.size());
    count += double(views[i].points.size());
  }
  c.all_rms = std::sqrt(sum / count);
  c.focal_sigma = camera.focal_sigma;
  c.principal_sigma = camera.principal_sigma;
  c.object_error = camera.object_error;
  c.model = camera.model;
  c.lens_known = camera.lens_known;
  return c;
}

}  // namespace photohull
