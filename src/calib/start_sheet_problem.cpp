// Based on: Z. Zhang, "A flexible new technique for camera calibration", 2000 [Zhang00];
// T. Collins, A. Bartoli, "Infinitesimal plane-based pose estimation", 2014 [Collins14].
#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "calib/sheet_problem.h"
#include "core/error.h"

namespace photohull {
namespace {

constexpr double kShareOfDiagonal = 0.012;  // that a lens may move a tag off a plane's picture
constexpr double kUsualFocal = 0.9;         // of the longer side
constexpr double kShortest = 0.25, kLongest = 25;  // of the longer side

std::vector<cv::Point2f> places_of(const BoardView& view) {
  std::vector<cv::Point2f> all;
  for (const glm::dvec3& p : view.points) all.emplace_back(float(p.x), float(p.y));
  return all;
}

std::vector<cv::Point2f> pixels_of(const BoardView& view) {
  std::vector<cv::Point2f> all;
  for (const glm::dvec2& p : view.pixels) all.emplace_back(float(p.x), float(p.y));
  return all;
}

/// From the homographies of all its photographs, for square pixels about the middle.
double focal_from_tags(const SheetProblem& problem, const SheetCamera& camera) {
  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const std::size_t i : camera.photos) {
    points.emplace_back();
    for (const glm::dvec3& p : problem.photos[i].view.points)
      points.back().emplace_back(float(p.x), float(p.y), 0.0f);
    pixels.push_back(pixels_of(problem.photos[i].view));
  }
  const double longer = std::max(camera.size.x, camera.size.y);
  const cv::Mat k =
      cv::initCameraMatrix2D(points, pixels, cv::Size(camera.size.x, camera.size.y), 1.0);
  const double focal = k.at<double>(0, 0);
  const bool possible = focal > kShortest * longer && focal < kLongest * longer;
  return possible ? focal : kUsualFocal * longer;
}

void group_cameras(const std::vector<PosePhoto>& photos, SheetProblem& problem) {
  for (std::size_t i = 0; i < photos.size(); ++i) {
    if (!problem.photos[i].used) continue;
    const glm::ivec2 size = photos[i].view.board.size();
    auto at = std::find_if(
        problem.cameras.begin(), problem.cameras.end(),
        [&](const SheetCamera& c) { return c.name == photos[i].camera && c.size == size; });
    if (at == problem.cameras.end()) {
      problem.cameras.push_back({photos[i].camera, size, photos[i].focal, {}, {}});
      at = std::prev(problem.cameras.end());
    }
    problem.photos[i].camera = std::size_t(at - problem.cameras.begin());
    at->photos.push_back(i);
  }
}

/// By RANSAC, of points that lie in no plane [Terzakis20]; false where no pose fits.
bool start_around(const SheetProblem& problem, const Lens& lens, SheetPhoto& photo) {
  constexpr double kOff = 0.005;  // of the focal length
  constexpr int kTrials = 200;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> seen;
  for (const glm::dvec3& p : photo.view.points) points.emplace_back(p.x, p.y, p.z);
  for (const glm::dvec2& p : undistorted(photo.view.pixels, problem.model, lens))
    seen.emplace_back(p.x, p.y);
  cv::Mat turn, move;
  std::vector<int> fit;
  try {
    if (!cv::solvePnPRansac(points, seen, cv::Matx33d::eye(), {}, turn, move, false, kTrials,
                            float(kOff), 0.999, fit, cv::SOLVEPNP_SQPNP))
      return false;
  } catch (const cv::Exception&) {
    return false;
  }
  for (int c = 0; c < 3; ++c) {
    photo.pose[std::size_t(c)] = turn.at<double>(c);
    photo.pose[std::size_t(3 + c)] = move.at<double>(c);
  }
  return 2 * fit.size() > points.size() && std::isfinite(problem.rms(photo));
}

/// Of a strip around a cylinder: photographs that get a pose with that lens. The mean of their
/// errors' squares, pixels.
double start_all_around(SheetProblem& problem, SheetCamera& camera, double focal) {
  camera.lens = {focal, focal, (camera.size.x - 1) / 2.0, (camera.size.y - 1) / 2.0};
  double sum = 0, count = 0;
  for (const std::size_t i : camera.photos) {
    SheetPhoto& photo = problem.photos[i];
    photo.used = start_around(problem, camera.lens, photo);
    const double longer = std::max(camera.size.x, camera.size.y);
    const double off = photo.used ? problem.rms(photo) : longer;
    sum += std::min(off, longer) * std::min(off, longer), ++count;
  }
  return sum / std::max(1.0, count);
}

/// Its stated focal length, or the one of some that fits best.
void start_rim_camera(SheetProblem& problem, SheetCamera& camera) {
  double focal = camera.stated_focal, least = INFINITY;
  for (const double share : {0.6, 0.8, 1.0, 1.3, 1.7, 2.2, 3.0, 4.0}) {
    if (camera.stated_focal > 0) break;
    const double tried = share * std::max(camera.size.x, camera.size.y);
    const double off = start_all_around(problem, camera, tried);
    if (off < least) least = off, focal = tried;
  }
  start_all_around(problem, camera, focal);
}

}  // namespace

void start_sheet_problem(const std::vector<PosePhoto>& photos, SheetProblem& problem) {
  group_cameras(photos, problem);
  for (SheetCamera& camera : problem.cameras) {
    if (!problem.flat) {
      start_rim_camera(problem, camera);
      continue;
    }
    const double focal =
        camera.stated_focal > 0 ? camera.stated_focal : focal_from_tags(problem, camera);
    camera.lens = {focal, focal, (camera.size.x - 1) / 2.0, (camera.size.y - 1) / 2.0};
    for (const std::size_t i : camera.photos) {
      SheetPhoto& photo = problem.photos[i];
      try {
        photo.pose = start_poses({photo.view}, {0}, problem.model, camera.lens)[0];
        photo.used = std::isfinite(problem.rms(photo));
      } catch (const Error&) {
        photo.used = false;
      }
    }
  }
}

int drop_wrong_tags(SheetPhoto& photo) {
  BoardView& view = photo.view;
  const double limit =
      std::max(3.0, kShareOfDiagonal * std::hypot(double(view.width), double(view.height)));
  const std::vector<cv::Point2f> places = places_of(view), pixels = pixels_of(view);
  const cv::Mat h = cv::findHomography(places, pixels, cv::RANSAC, limit);
  if (h.empty()) return 0;
  std::vector<cv::Point2f> expected;
  cv::perspectiveTransform(places, expected, h);
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!(cv::norm(expected[i] - pixels[i]) <= limit)) wrong.push_back(photo.group[i]);
  std::sort(wrong.begin(), wrong.end());
  wrong.erase(std::unique(wrong.begin(), wrong.end()), wrong.end());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    if (std::binary_search(wrong.begin(), wrong.end(), photo.group[i])) continue;
    view.points[kept] = view.points[i], view.pixels[kept] = view.pixels[i];
    photo.group[kept++] = photo.group[i];
  }
  view.points.resize(kept), view.pixels.resize(kept), photo.group.resize(kept);
  return int(wrong.size());
}

}  // namespace photohull
