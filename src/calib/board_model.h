// Lenses, poses and residuals of calibration from boards. Internal to calib; only for files that
// know Ceres.
#pragma once

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "calib/calibrate_board.h"

namespace photohull {

inline constexpr std::size_t kFewestBoardPoints = 6, kFewestBoardViews = 3;
inline constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

/// Views are outliers beyond this many times the median rms, but not below so many pixels.
inline constexpr double kOutlierFactor = 3, kHarmlessRms = 0.25;

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

glm::dmat3 rotation_of(const Rigid& pose);
Pose pose_of(const Rigid& pose);
Rigid rigid_of(const Pose& pose);

/// Root mean square distance in pixels of the view's points from where they should be.
double view_rms(const BoardView& view, LensModel model, const Lens& lens, const Rigid& pose);

/// Views whose rms is beyond this are outliers among those of `rms`, pixels.
double outlier_limit(const std::vector<double>& rms);

/// Throws Error naming the view that is of another size than the first one used.
void check_same_size(const std::vector<BoardView>& views, const std::vector<std::size_t>& used);

/// Zhang's method [Zhang00] by OpenCV over the views `used`; `poses` has one for every view.
struct BoardStart {
  Lens lens{};
  std::vector<Rigid> poses;
};
BoardStart start_calibration(const std::vector<BoardView>& views,
                             const std::vector<std::size_t>& used, LensModel model);

/// Directions (x, y, 1) that pixels show.
std::vector<glm::dvec2> undistorted(const std::vector<glm::dvec2>& pixels, LensModel model,
                                    const Lens& lens);

/// Poses of the board in the views `used` under a lens that is known, each by itself [Collins14].
std::vector<Rigid> start_poses(const std::vector<BoardView>& views,
                               const std::vector<std::size_t>& used, LensModel model,
                               const Lens& lens);

/// Which of the models describes the distortion. Throws Error where none does.
LensModel model_of(const Distortion& distortion);
/// A lens that is known, as blocks of a problem. Throws Error for one with skew.
Lens lens_of(const KnownLens& known);

/// A lens in the problem, with what its model does not have held as it is; all of it if `known`.
void hold_lens(ceres::Problem& problem, LensModel model, bool known, Lens& lens);

/// Throws Error when it does not converge. `eliminated`: blocks that no residual has two of.
void solve(ceres::Problem& problem, const std::vector<double*>& eliminated = {});

/// Standard deviations of every parameter, from the inverse of the normal matrix and scaled by the
/// residuals' own spread; none for blocks that are held.
class StandardDeviations {
 public:
  explicit StandardDeviations(ceres::Problem& problem);
  /// Of a block's parameters, zero for those that are held. Empty where the problem is degenerate.
  std::vector<double> of(const double* block) const;

  /// Free blocks of the problem, in the order of the covariance's rows.
  const std::vector<double*>& blocks() const { return blocks_; }
  /// Of all tangents of the free blocks; empty where the problem is degenerate.
  const Eigen::MatrixXd& covariance() const { return covariance_; }

 private:
  ceres::Problem& problem_;
  std::vector<double*> blocks_;
  std::vector<int> first_;  ///< tangent column of each block
  Eigen::MatrixXd covariance_;
};

/// Intrinsics and distortion as the rest of the program has them.
void set_lens(const Lens& lens, LensModel model, int width, int height, Intrinsics& intrinsics,
              Distortion& distortion);

/// Pixels by which perspective and the lens move the middle of a dot's picture off the picture of
/// its middle: the centroid of the area that its rim encloses, less the projected centre.
glm::dvec2 dot_bias(LensModel model, const Lens& lens, const Rigid& pose, const glm::dvec3& centre,
                    double radius);

/// One camera and where it saw the board.
struct SingleCamera {
  LensModel model = LensModel::kBrown;
  bool lens_known = false;        ///< and held as it is
  std::vector<BoardView> views;   ///< dots' pixels moved to where their middles are imaged
  std::vector<std::size_t> used;  ///< views that count, ascending
  Lens lens{};
  std::vector<Rigid> poses;  ///< camera from board, of each view that the board was found in
  double focal_sigma = 0, principal_sigma = 0;  ///< pixels
  double object_error = 0;                      ///< as Calibration has it

  /// So many views must count.
  std::size_t fewest_views() const { return lens_known ? 1 : kFewestBoardViews; }
  std::vector<double> rms() const;  ///< of each view, NaN where the board was not found
  void note_sigma(const std::vector<double>& lens_sigma);
};

/// Start, outliers left out, refinement. Throws as calibrate() does.
SingleCamera calibrate_camera(const std::vector<BoardView>& views, LensModel model,
                              const std::optional<KnownLens>& known);

/// All views of the camera by one axis and an angle each, free or as `angles` has them (degrees, of
/// each view): refines the lens too, moves the poses onto the table, and takes views that do not
/// fit out of those used. Throws Error where the board does not turn, or not as stated.
TurntableAxis refine_turntable(SingleCamera& camera, const std::vector<double>& angles);

}  // namespace photohull
