#include "calib/judge_calibration.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull {
namespace {

// Reconstructions need cameras to a part of a pixel, of photographs as large as the boards'.
constexpr double kMostPixels = 2, kMostOfDiagonal = 1e-3;
constexpr double kDoubtful = 0.25;                           // of these
constexpr double kShortestFocal = 0.1, kLongestFocal = 100;  // of the picture's longer side
constexpr double kMostStretched = 2, kStretched = 1.05;      // fx / fy, or its inverse
constexpr double kOffMiddle = 0.2;                           // of the picture's width and height

constexpr const char* kTilt =
    "photograph the board tilted by 30 to 45 degrees to different sides, in all parts of the "
    "picture, ten times or more";

std::string check_board() {
  return concat("check ", option_word("board"), ", ", option_word("columns"), ", ",
                option_word("rows"), " and ", option_word("square"),
                ", and photograph a flat, stiff board, sharp and at rest");
}

double limit_of(const Intrinsics& k) {
  return std::max(kMostPixels, kMostOfDiagonal * std::hypot(k.width, k.height));
}

/// Three digits, for people.
std::string short_text(double value) {
  if (std::isinf(value)) return "infinite";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

double square_ratio(const Intrinsics& k) { return std::max(k.fx / k.fy, k.fy / k.fx); }

/// What no camera has, or nothing.
std::string impossible_lens(const Intrinsics& k) {
  const double side = std::max(k.width, k.height), least = std::min(k.fx, k.fy);
  const std::string focal =
      concat("the focal length found is ", short_text(k.fx), ", ", short_text(k.fy), " px");
  if (!(least > 0)) return focal + ", which no camera has";
  if (!(least > kShortestFocal * side && std::max(k.fx, k.fy) < kLongestFocal * side))
    return concat(focal, " for pictures of ", k.width, " x ", k.height, ", which no lens has");
  if (!(square_ratio(k) < kMostStretched)) return focal + ": pixels are nearly square";
  if (!(k.cx > -0.5 && k.cy > -0.5 && k.cx < k.width - 0.5 && k.cy < k.height - 0.5))
    return concat("the principal point found, ", short_text(k.cx), ", ", short_text(k.cy),
                  ", is not in the picture of ", k.width, " x ", k.height);
  return {};
}

class Judge {
 public:
  explicit Judge(std::string who = {}) : who_(std::move(who)) {}

  void lens(const Intrinsics& k, const char* mend) {
    const std::string what = impossible_lens(k);
    if (!what.empty()) return refuse(what, mend);
    if (square_ratio(k) > kStretched)
      doubt(concat("its pixels are not square (focal length ", short_text(k.fx), ", ",
                   short_text(k.fy), " px), as those of nearly all cameras are"),
            mend);
    const glm::dvec2 off(k.cx / (k.width - 1) - 0.5, k.cy / (k.height - 1) - 0.5);
    if (std::max(std::abs(off.x), std::abs(off.y)) > kOffMiddle)
      doubt(concat("the principal point, ", short_text(k.cx), ", ", short_text(k.cy),
                   ", is far from the middle of the picture of ", k.width, " x ", k.height,
                   ", which only cropped pictures explain"),
            mend);
  }

  void fit(double rms, double limit) {
    if (rms > kDoubtful * limit) out_.misfits = true;
    const std::string what = concat("the boards fit to ", short_text(rms), " px rms only");
    if (!(rms <= limit))
      refuse(what, check_board());
    else if (rms > kDoubtful * limit)
      doubt(what, check_board());
  }

  /// `known_to`: the numbers behind it.
  void object(double error, double limit, const std::string& known_to, const std::string& mend) {
    const std::string what =
        concat(std::isinf(error) ? "the pictures leave the cameras undetermined"
                                 : concat("the cameras are known to ", short_text(error),
                                          " px only where an object would stand"),
               known_to.empty() ? "" : " (" + known_to + ")");
    if (!(error <= limit))
      refuse(what, mend);
    else if (error > kDoubtful * limit)
      doubt(what, mend);
  }

  void left_out(const std::vector<BoardView>& views, const std::vector<bool>& gone) {
    std::size_t found = 0, used = 0;
    for (std::size_t i = 0; i < views.size(); ++i)
      found += !views[i].points.empty(), used += !gone[i];
    if (2 * used < found)
      doubt(concat("only ", used, " of ", found,
                   " pictures of the board fit each other, and the rest was left out"),
            check_board());
  }

  CalibrationJudgement take() { return std::move(out_); }

 private:
  void refuse(const std::string& what, const std::string& mend) {
    if (out_.refusal.empty()) out_.refusal = who_ + what + "; " + mend;
  }
  void doubt(const std::string& what, const std::string& mend) {
    out_.doubts.push_back(who_ + what + "; " + mend);
  }

  std::string who_;
  CalibrationJudgement out_;
};

std::string sigma_text(const Intrinsics& k, double focal_sigma) {
  return concat("focal length ", short_text(k.fx), " +- ", short_text(focal_sigma), " px");
}

std::string mend_of(const Calibration& c) {
  if (!c.turntable) return c.lens_known ? "photograph the board from nearer and tilted" : kTilt;
  if (c.lens_known)
    return "turn the table further, in more pictures, with the board nearer and well off the view "
           "along its plane";
  return concat(
      "lean the board on the table so that it is tilted by 30 to 60 degrees against the axis, and "
      "turn the table further; or calibrate the lens by pictures of the board tilted to different "
      "sides, and give that with ",
      option_word("lens_from"));
}

void add(const CalibrationJudgement& from, CalibrationJudgement& to) {
  if (to.refusal.empty()) to.refusal = from.refusal;
  to.doubts.insert(to.doubts.end(), from.doubts.begin(), from.doubts.end());
  to.misfits = to.misfits || from.misfits;
}

}  // namespace

CalibrationJudgement judge_calibration(const std::vector<BoardView>& views, const Calibration& c) {
  Judge judge;
  const Intrinsics& k = c.intrinsics;
  std::string known_to = c.lens_known ? "" : sigma_text(k, c.focal_sigma);
  if (c.turntable)
    known_to += concat(known_to.empty() ? "" : ", ", "axis +- ",
                       short_text(c.turntable->direction_sigma), " degrees");
  judge.fit(c.all_rms, limit_of(k));
  if (!c.lens_known) judge.lens(k, c.turntable ? mend_of(c).c_str() : kTilt);
  judge.object(c.object_error, limit_of(k), std::isinf(c.object_error) ? "" : known_to, mend_of(c));
  judge.left_out(views, c.left_out);
  return judge.take();
}

CalibrationJudgement judge_calibration(const RigCalibration& rig) {
  CalibrationJudgement all;
  double limit = INFINITY, worst = 0;
  std::string known_to;
  for (const RigCamera& camera : rig.cameras) {
    Judge judge("camera " + camera.name + ": ");
    judge.fit(camera.all_rms, limit_of(camera.intrinsics));
    if (!camera.lens_known) judge.lens(camera.intrinsics, kTilt);
    add(judge.take(), all);
    limit = std::min(limit, limit_of(camera.intrinsics));
    const double sigma = camera.lens_known ? 0 : camera.focal_sigma / camera.intrinsics.fx;
    if (sigma > worst) {
      worst = sigma;
      known_to =
          concat("camera ", camera.name, ": ", sigma_text(camera.intrinsics, camera.focal_sigma));
    }
  }
  Judge judge;
  judge.object(rig.object_error, limit, std::isinf(rig.object_error) ? "" : known_to,
               "hold the board tilted to different sides where two cameras or more see it, at ten "
               "moments or more");
  add(judge.take(), all);
  return all;
}

}  // namespace photohull
