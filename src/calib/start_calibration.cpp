// Based on: Z. Zhang, "A flexible new technique for camera calibration", 2000 [Zhang00];
// T. Collins, A. Bartoli, "Infinitesimal plane-based pose estimation", 2014 [Collins14].
#include <opencv2/calib3d.hpp>

#include "calib/board_model.h"
#include "core/error.h"

namespace photohull {
namespace {

using Points = std::vector<std::vector<cv::Point3f>>;
using Pixels = std::vector<std::vector<cv::Point2f>>;

struct Found {
  cv::Mat k, d;
  std::vector<cv::Mat> turns, moves;
};

/// OpenCV's own start, and where that leads nowhere, a pinhole with Brown's poses.
Found start_fisheye(const Points& points, const Pixels& pixels, const cv::Size& size) {
  Found f;
  bool good = true;
  try {
    cv::fisheye::calibrate(points, pixels, size, f.k, f.d, f.turns, f.moves,
                           cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW);
    for (const cv::Mat& move : f.moves) good = good && move.at<double>(2) > 0;
  } catch (const cv::Exception&) {
    good = false;
  }
  if (good && cv::checkRange(f.k) && cv::checkRange(f.d)) return f;
  cv::calibrateCamera(points, pixels, size, f.k, f.d, f.turns, f.moves);
  f.d = cv::Mat::zeros(1, 4, CV_64F);
  return f;
}

int flags_of(LensModel lens) {
  if (lens == LensModel::kRational) return cv::CALIB_RATIONAL_MODEL;
  if (lens == LensModel::kBrown) return 0;
  return cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
}

/// Directions (x, y, 1) of a view's pixels.
std::vector<cv::Point2d> directions(const BoardView& view, LensModel model, const Lens& lens) {
  std::vector<cv::Point2d> found;
  for (const glm::dvec2& d : undistorted(view.pixels, model, lens)) found.emplace_back(d.x, d.y);
  return found;
}

}  // namespace

std::vector<glm::dvec2> undistorted(const std::vector<glm::dvec2>& pixels, LensModel model,
                                    const Lens& lens) {
  std::vector<cv::Point2d> in, found;
  for (const glm::dvec2& p : pixels) in.emplace_back(p.x, p.y);
  const cv::Matx33d k(lens[0], 0, lens[2], 0, lens[1], lens[3], 0, 0, 1);
  std::vector<double> d(lens.begin() + 4, lens.end());
  if (model == LensModel::kFisheye) {
    d.resize(4);
    cv::fisheye::undistortPoints(in, found, k, d);
  } else {
    cv::undistortPoints(in, found, k, d);
  }
  std::vector<glm::dvec2> out;
  for (const cv::Point2d& p : found) out.emplace_back(p.x, p.y);
  return out;
}

std::vector<Rigid> start_poses(const std::vector<BoardView>& views,
                               const std::vector<std::size_t>& used, LensModel model,
                               const Lens& lens) {
  std::vector<Rigid> poses(views.size());
  for (const std::size_t i : used) {
    std::vector<cv::Point3d> points;
    for (const glm::dvec3& p : views[i].points) points.emplace_back(p.x, p.y, p.z);
    cv::Mat turn, move;
    try {
      cv::solvePnP(points, directions(views[i], model, lens), cv::Matx33d::eye(), {}, turn, move,
                   false, cv::SOLVEPNP_IPPE);
    } catch (const cv::Exception& failure) {
      throw Error(concat(views[i].name, ": no pose fits the board under the known lens (",
                         failure.err, "); is it that of these pictures?"));
    }
    for (int c = 0; c < 3; ++c) {
      poses[i][std::size_t(c)] = turn.at<double>(c);
      poses[i][std::size_t(3 + c)] = move.at<double>(c);
    }
  }
  return poses;
}

BoardStart start_calibration(const std::vector<BoardView>& views,
                             const std::vector<std::size_t>& used, LensModel model) {
  Points points;
  Pixels pixels;
  for (const std::size_t i : used) {
    points.emplace_back();
    pixels.emplace_back();
    for (std::size_t k = 0; k < views[i].points.size(); ++k) {
      const glm::dvec3& p = views[i].points[k];
      points.back().emplace_back(float(p.x), float(p.y), float(p.z));
      pixels.back().emplace_back(float(views[i].pixels[k].x), float(views[i].pixels[k].y));
    }
  }
  const cv::Size size(views[used[0]].width, views[used[0]].height);
  Found f;
  try {
    if (model == LensModel::kFisheye)
      f = start_fisheye(points, pixels, size);
    else
      cv::calibrateCamera(points, pixels, size, f.k, f.d, f.turns, f.moves, flags_of(model));
  } catch (const cv::Exception& failure) {
    throw Error(concat("the pictures do not determine the camera (", failure.err,
                       "); photograph the board from more sides, tilted"));
  }
  f.k.convertTo(f.k, CV_64F);
  f.d.convertTo(f.d, CV_64F);
  BoardStart start;
  start.lens = {f.k.at<double>(0, 0), f.k.at<double>(1, 1), f.k.at<double>(0, 2),
                f.k.at<double>(1, 2)};
  for (int i = 0; i < std::min(int(f.d.total()), 8); ++i) start.lens[4 + i] = f.d.at<double>(i);
  start.poses.resize(views.size());
  for (std::size_t n = 0; n < used.size(); ++n)
    for (int i = 0; i < 3; ++i) {
      start.poses[used[n]][i] = f.turns[n].at<double>(i);
      start.poses[used[n]][3 + i] = f.moves[n].at<double>(i);
    }
  return start;
}

}  // namespace photohull
