// Based on: Z. Zhang, "A flexible new technique for camera calibration", 2000 [Zhang00].
#include "calib/calibrate_board.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/median.h"
#include "core/error.h"

namespace photohull {
namespace {

constexpr std::size_t kFewestPoints = 6, kFewestViews = 3;
constexpr double kDegrees = 180 / std::numbers::pi;

using Lens = std::array<double, 12>;  ///< fx fy cx cy, then Distortion's coefficients
using Rigid = std::array<double, 6>;  ///< rotation vector, translation

/// Where the lens images a point of the camera's frame.
template <typename T>
void project(LensModel model, const T* lens, const T* p, T* pixel) {
  using std::atan2;
  using std::sqrt;
  T x = p[0] / p[2], y = p[1] / p[2];
  const T* k = lens + 4;
  const T r2 = x * x + y * y;
  if (model == LensModel::kFisheye) {
    const T r = sqrt(r2 + 1e-24), theta = atan2(r, T(1)), t2 = theta * theta;
    const T scale = theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))) / r;
    x *= scale, y *= scale;
  } else {
    const T radial = (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) /
                     (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
    const T dx = 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x);
    const T dy = k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y;
    x = x * radial + dx, y = y * radial + dy;
  }
  pixel[0] = lens[0] * x + lens[2];
  pixel[1] = lens[1] * y + lens[3];
}

template <typename T>
void to_camera(const T* pose, const glm::dvec3& point, T* p) {
  const T start[3] = {T(point.x), T(point.y), T(point.z)};
  ceres::AngleAxisRotatePoint(pose, start, p);
  for (int i = 0; i < 3; ++i) p[i] += pose[3 + i];
}

struct BoardResidual {
  LensModel model;
  glm::dvec3 point;
  glm::dvec2 pixel;

  template <typename T>
  bool operator()(const T* lens, const T* pose, T* residual) const {
    T p[3];
    to_camera(pose, point, p);
    if (!(p[2] > 0.0)) return false;
    project(model, lens, p, residual);
    residual[0] -= pixel.x, residual[1] -= pixel.y;
    return true;
  }
};

/// An axis near a given one: two angles and two lengths across it.
struct Axis {
  glm::dvec3 direction, point, x, y;

  template <typename T>
  void at(const T* change, T* d, T* p) const {
    using std::sqrt;
    T length = T(0);
    for (int i = 0; i < 3; ++i) {
      d[i] = direction[i] + change[0] * x[i] + change[1] * y[i];
      p[i] = point[i] + change[2] * x[i] + change[3] * y[i];
      length += d[i] * d[i];
    }
    for (int i = 0; i < 3; ++i) d[i] /= sqrt(length);
  }
};

/// The board of the first view, turned about the axis.
struct TurntableResidual {
  LensModel model;
  const Axis& axis;
  glm::dvec3 point;
  glm::dvec2 pixel;

  template <typename T>
  bool operator()(const T* lens, const T* first, const T* change, const T* angle,
                  T* residual) const {
    T p[3], d[3], c[3], q[3];
    to_camera(first, point, p);
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

double view_rms(const BoardView& view, LensModel model, const Lens& lens, const Rigid& pose) {
  double sum = 0;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    double p[3], pixel[2];
    to_camera(pose.data(), view.points[i], p);
    project(model, lens.data(), p, pixel);
    sum += std::pow(pixel[0] - view.pixels[i].x, 2) + std::pow(pixel[1] - view.pixels[i].y, 2);
  }
  return std::sqrt(sum / double(view.points.size()));
}

class Calibrator {
 public:
  Calibrator(const std::vector<BoardView>& views, const CalibrateOptions& options)
      : views_(views), options_(options), poses_(views.size()), rms_(views.size(), NAN) {}

  Calibration run() {
    for (std::size_t i = 0; i < views_.size(); ++i)
      if (views_[i].points.size() >= kFewestPoints) used_.push_back(i);
    check();
    start();
    drop_outliers();
    refine();
    if (options_.turntable) refine_turntable();
    return result();
  }

 private:
  void check() const {
    if (used_.size() < kFewestViews)
      throw Error(concat("the board was found in ", used_.size(), " of ", views_.size(),
                         " pictures, but three are needed; check --board, --columns and --rows"));
    for (const std::size_t i : used_)
      if (views_[i].width != views_[used_[0]].width || views_[i].height != views_[used_[0]].height)
        throw Error(concat(views_[i].name, ": the picture is of another size than ",
                           views_[used_[0]].name, "; calibrate one camera at one resolution"));
  }

  /// Zhang's method, by OpenCV.
  void start() {
    std::vector<std::vector<cv::Point3f>> points;
    std::vector<std::vector<cv::Point2f>> pixels;
    for (const std::size_t i : used_) {
      points.emplace_back();
      pixels.emplace_back();
      for (std::size_t k = 0; k < views_[i].points.size(); ++k) {
        const glm::dvec3& p = views_[i].points[k];
        points.back().emplace_back(float(p.x), float(p.y), float(p.z));
        pixels.back().emplace_back(float(views_[i].pixels[k].x), float(views_[i].pixels[k].y));
      }
    }
    const cv::Size size(views_[used_[0]].width, views_[used_[0]].height);
    cv::Mat k, d;
    std::vector<cv::Mat> turns, moves;
    try {
      if (options_.lens == LensModel::kFisheye)
        start_fisheye(points, pixels, size, k, d, turns, moves);
      else
        cv::calibrateCamera(points, pixels, size, k, d, turns, moves, flags());
    } catch (const cv::Exception& failure) {
      throw Error(concat("the pictures do not determine the camera (", failure.err,
                         "); photograph the board from more sides, tilted"));
    }
    k.convertTo(k, CV_64F);
    d.convertTo(d, CV_64F);
    lens_ = {k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2)};
    for (int i = 0; i < std::min(int(d.total()), 8); ++i) lens_[4 + i] = d.at<double>(i);
    for (std::size_t n = 0; n < used_.size(); ++n)
      for (int i = 0; i < 3; ++i) {
        poses_[used_[n]][i] = turns[n].at<double>(i);
        poses_[used_[n]][3 + i] = moves[n].at<double>(i);
      }
  }

  /// OpenCV's own start, and where that leads nowhere, a pinhole with Brown's poses.
  static void start_fisheye(const std::vector<std::vector<cv::Point3f>>& points,
                            const std::vector<std::vector<cv::Point2f>>& pixels,
                            const cv::Size& size, cv::Mat& k, cv::Mat& d,
                            std::vector<cv::Mat>& turns, std::vector<cv::Mat>& moves) {
    bool good = true;
    try {
      cv::fisheye::calibrate(points, pixels, size, k, d, turns, moves,
                             cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW);
      for (const cv::Mat& move : moves) good = good && move.at<double>(2) > 0;
    } catch (const cv::Exception&) {
      good = false;
    }
    if (good && cv::checkRange(k) && cv::checkRange(d)) return;
    cv::calibrateCamera(points, pixels, size, k, d, turns, moves);
    d = cv::Mat::zeros(1, 4, CV_64F);
  }

  int flags() const {
    if (options_.lens == LensModel::kRational) return cv::CALIB_RATIONAL_MODEL;
    if (options_.lens == LensModel::kBrown) return 0;
    return cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
  }

  void measure() {
    for (std::size_t i = 0; i < views_.size(); ++i)
      if (views_[i].points.size() >= kFewestPoints)
        rms_[i] = view_rms(views_[i], options_.lens, lens_, poses_[i]);
  }

  /// Views three times as far off as the median one; again without them until there are no more.
  void drop_outliers() {
    constexpr double kOutlier = 3, kHarmless = 0.25;  // pixels
    for (;;) {
      measure();
      std::vector<double> rms;
      for (const std::size_t i : used_) rms.push_back(rms_[i]);
      const double limit = std::max(kHarmless, kOutlier * median(rms));
      std::vector<std::size_t> kept;
      for (const std::size_t i : used_)
        if (rms_[i] <= limit) kept.push_back(i);
      if (kept.size() == used_.size() || kept.size() < kFewestViews) return;
      used_ = kept;
      start();
    }
  }

  /// Coefficients that the model does not have stay as they are.
  void hold_lens(ceres::Problem& problem) {
    std::vector<int> fixed;
    const auto fix_from = [&](int first) {
      for (int i = first; i < 12; ++i) fixed.push_back(i);
    };
    switch (options_.lens) {
      case LensModel::kPinhole:
        fix_from(4);
        break;
      case LensModel::kBrown:
        fix_from(9);
        break;
      case LensModel::kFisheye:
        fix_from(8);
        break;
      case LensModel::kRational:
        return;
    }
    problem.SetManifold(lens_.data(), new ceres::SubsetManifold(12, fixed));
  }

  void solve(ceres::Problem& problem) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable())
      throw Error("the calibration does not converge; photograph the board from more sides");
  }

  /// Standard deviations, scaled by the residuals' own spread.
  bool covariance(ceres::Problem& problem, const std::vector<const double*>& blocks,
                  std::vector<std::vector<double>>& out, const std::vector<int>& sizes) {
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    options.null_space_rank = -1;
    ceres::Covariance covariance(options);
    std::vector<std::pair<const double*, const double*>> pairs;
    for (const double* block : blocks) pairs.emplace_back(block, block);
    if (!covariance.Compute(pairs, &problem)) return false;
    double cost = 0;
    problem.Evaluate({}, &cost, nullptr, nullptr, nullptr);
    const double free = std::max(1, problem.NumResiduals() - problem.NumParameters());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      std::vector<double> matrix(std::size_t(sizes[b] * sizes[b])), sigma;
      covariance.GetCovarianceBlock(blocks[b], blocks[b], matrix.data());
      for (int i = 0; i < sizes[b]; ++i)
        sigma.push_back(
            std::sqrt(std::max(0.0, matrix[std::size_t(i * sizes[b] + i)] * 2 * cost / free)));
      out.push_back(sigma);
    }
    return true;
  }

  void note_lens_sigma(const std::vector<double>& sigma) {
    focal_sigma_ = std::max(sigma[0], sigma[1]);
    principal_sigma_ = std::max(sigma[2], sigma[3]);
  }

  void refine() {
    ceres::Problem problem;
    for (const std::size_t i : used_)
      for (std::size_t k = 0; k < views_[i].points.size(); ++k)
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<BoardResidual, 2, 12, 6>(
                new BoardResidual{options_.lens, views_[i].points[k], views_[i].pixels[k]}),
            new ceres::HuberLoss(1), lens_.data(), poses_[i].data());
    hold_lens(problem);
    solve(problem);
    std::vector<std::vector<double>> sigma;
    if (covariance(problem, {lens_.data()}, sigma, {12})) note_lens_sigma(sigma[0]);
    measure();
  }

  static glm::dmat3 rotation_of(const Rigid& pose) {
    double columns[9];
    ceres::AngleAxisToRotationMatrix(pose.data(), columns);
    glm::dmat3 r;
    for (int i = 0; i < 9; ++i) r[i / 3][i % 3] = columns[i];
    return r;
  }

  /// The axis that turns the first view's board into each of the others', on average.
  Axis guess_axis(std::vector<double>& angles) const {
    const glm::dmat3 first = rotation_of(poses_[used_[0]]);
    const glm::dvec3 t0(poses_[used_[0]][3], poses_[used_[0]][4], poses_[used_[0]][5]);
    std::vector<glm::dvec3> turns;
    glm::dvec3 direction(0.0);
    for (const std::size_t i : used_) {
      const glm::dmat3 r = rotation_of(poses_[i]) * glm::transpose(first);
      double columns[9], turn[3];
      for (int k = 0; k < 9; ++k) columns[k] = r[k / 3][k % 3];
      ceres::RotationMatrixToAngleAxis(columns, turn);
      turns.emplace_back(turn[0], turn[1], turn[2]);
      direction += glm::dot(turns.back(), direction) < 0 ? -turns.back() : turns.back();
    }
    if (!(glm::length(direction) > 0.02))
      throw Error("the board does not turn between the pictures; is this a turntable?");
    Axis axis;
    axis.direction = glm::normalize(direction);
    axis.x = glm::normalize(glm::cross(axis.direction, std::abs(axis.direction.x) < 0.7
                                                           ? glm::dvec3(1, 0, 0)
                                                           : glm::dvec3(0, 1, 0)));
    axis.y = glm::cross(axis.direction, axis.x);
    // c = R c + (t - R t0): least squares over the views, across the axis.
    glm::dmat3 normal = glm::outerProduct(axis.direction, axis.direction);
    glm::dvec3 right = axis.direction * glm::dot(axis.direction, t0);
    for (std::size_t n = 0; n < used_.size(); ++n) {
      const Rigid& pose = poses_[used_[n]];
      const glm::dmat3 r = rotation_of(pose) * glm::transpose(first), a = glm::dmat3(1.0) - r;
      normal += glm::transpose(a) * a;
      right += glm::transpose(a) * (glm::dvec3(pose[3], pose[4], pose[5]) - r * t0);
      angles.push_back(glm::dot(turns[n], axis.direction));
    }
    axis.point = glm::inverse(normal) * right;
    return axis;
  }

  void refine_turntable() {
    std::vector<double> angles;
    const Axis axis = guess_axis(angles);
    std::array<double, 4> change{};
    Rigid first = poses_[used_[0]];
    ceres::Problem problem;
    for (std::size_t n = 0; n < used_.size(); ++n) {
      const BoardView& view = views_[used_[n]];
      for (std::size_t k = 0; k < view.points.size(); ++k)
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<TurntableResidual, 2, 12, 6, 4, 1>(
                new TurntableResidual{options_.lens, axis, view.points[k], view.pixels[k]}),
            new ceres::HuberLoss(1), lens_.data(), first.data(), change.data(), &angles[n]);
    }
    hold_lens(problem);
    problem.SetParameterBlockConstant(&angles[0]);
    solve(problem);
    std::vector<const double*> blocks = {lens_.data(), change.data()};
    std::vector<int> sizes = {12, 4};
    for (std::size_t n = 1; n < angles.size(); ++n)
      blocks.push_back(&angles[n]), sizes.push_back(1);
    std::vector<std::vector<double>> sigma;
    TurntableAxis table;
    axis.at(change.data(), &table.direction.x, &table.point.x);
    table.angles.assign(views_.size(), NAN);
    for (std::size_t n = 0; n < angles.size(); ++n) table.angles[used_[n]] = angles[n] * kDegrees;
    if (covariance(problem, blocks, sigma, sizes)) {
      note_lens_sigma(sigma[0]);
      table.direction_sigma = kDegrees * std::max(sigma[1][0], sigma[1][1]);
      for (std::size_t n = 2; n < sigma.size(); ++n)
        table.angle_sigma = std::max(table.angle_sigma, kDegrees * sigma[n][0]);
    }
    for (std::size_t n = 0; n < used_.size(); ++n)
      turn_pose(first, table, angles[n], poses_[used_[n]]);
    measure();
    turntable_ = table;
  }

  static void turn_pose(const Rigid& first, const TurntableAxis& table, double angle, Rigid& pose) {
    Rigid turn{};
    for (int i = 0; i < 3; ++i) turn[i] = table.direction[i] * angle;
    const glm::dmat3 r = rotation_of(turn), all = r * rotation_of(first);
    const glm::dvec3 t = r * (glm::dvec3(first[3], first[4], first[5]) - table.point) + table.point;
    double columns[9];
    for (int k = 0; k < 9; ++k) columns[k] = all[k / 3][k % 3];
    ceres::RotationMatrixToAngleAxis(columns, pose.data());
    for (int i = 0; i < 3; ++i) pose[3 + i] = t[i];
  }

  Calibration result() const {
    Calibration c;
    c.intrinsics = {
        views_[used_[0]].width, views_[used_[0]].height, lens_[0], lens_[1], 0, lens_[2], lens_[3]};
    if (options_.lens == LensModel::kFisheye) c.distortion.model = DistortionModel::kFisheye;
    if (options_.lens == LensModel::kBrown || options_.lens == LensModel::kRational)
      c.distortion.model = DistortionModel::kBrown;
    std::copy(lens_.begin() + 4, lens_.end(), c.distortion.coefficients.begin());
    c.rms = rms_;
    c.left_out.assign(views_.size(), true);
    c.cam_from_board.resize(views_.size());
    double sum = 0, count = 0;
    for (const std::size_t i : used_) {
      c.left_out[i] = false;
      c.cam_from_board[i] = {rotation_of(poses_[i]), {poses_[i][3], poses_[i][4], poses_[i][5]}};
      sum += rms_[i] * rms_[i] * double(views_[i].points.size());
      count += double(views_[i].points.size());
    }
    c.all_rms = std::sqrt(sum / count);
    c.focal_sigma = focal_sigma_;
    c.principal_sigma = principal_sigma_;
    c.turntable = turntable_;
    return c;
  }

  const std::vector<BoardView>& views_;
  CalibrateOptions options_;
  std::vector<std::size_t> used_;
  Lens lens_{};
  std::vector<Rigid> poses_;
  std::vector<double> rms_;
  double focal_sigma_ = 0, principal_sigma_ = 0;
  std::optional<TurntableAxis> turntable_;
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

Calibration calibrate(const std::vector<BoardView>& views, const CalibrateOptions& options) {
  return Calibrator(views, options).run();
}

ColourImage coverage_picture(const std::vector<BoardView>& views, const Calibration& calibration) {
  const Intrinsics& k = calibration.intrinsics;
  cv::Mat counts = cv::Mat::zeros(k.height, k.width, CV_32F);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (calibration.left_out[i]) continue;
    std::vector<cv::Point> points, hull;
    for (const glm::dvec2& p : views[i].pixels)
      points.emplace_back(int(std::lround(p.x)), int(std::lround(p.y)));
    cv::convexHull(points, hull);
    cv::Mat one = cv::Mat::zeros(k.height, k.width, CV_32F);
    cv::fillConvexPoly(one, hull, 1.0);
    counts += one;
  }
  double most = 1;
  cv::minMaxLoc(counts, nullptr, &most);
  ColourImage picture{k.width, k.height, ColourImage::Encoding::kSrgb8, false, {}};
  for (int y = 0; y < k.height; ++y)
    for (int x = 0; x < k.width; ++x) {
      const auto level =
          std::uint8_t(std::lround(255 * counts.at<float>(y, x) / std::max(1.0, most)));
      picture.bytes.insert(picture.bytes.end(), {level, level, level, 255});
    }
  return picture;
}

}  // namespace photohull
