// How a sheet that may be bent appears in a photograph. Internal to calib; only for files that know
// Ceres.
#pragma once

#include "calib/board_model.h"
#include "sheet/bend_sheet.h"

namespace photohull {

using Bend = std::array<double, 3>;  ///< mm at the distance `reach` from the origin: xx, xy, yy

/// Pixels; `point` in the sheet's frame, of the flat sheet where its z is 0.
struct SheetResidual {
  LensModel model;
  double reach;
  glm::dvec3 point;
  glm::dvec2 pixel;

  template <typename T>
  bool operator()(const T* lens, const T* pose, const T* bend, T* residual) const {
    T p[3] = {T(point.x), T(point.y), T(point.z)}, q[3];
    bend_sheet(bend, reach, p);
    ceres::AngleAxisRotatePoint(pose, p, q);
    for (int i = 0; i < 3; ++i) q[i] += pose[3 + i];
    if (!(q[2] > 0.0)) return false;
    project(model, lens, q, residual);
    residual[0] -= pixel.x, residual[1] -= pixel.y;
    return true;
  }
};

/// Paper bends without stretching: along one direction only. The smaller of the two principal
/// heights, over their size, which may be off by its deviation of `loose` mm.
struct PaperPrior {
  double loose;

  template <typename T>
  bool operator()(const T* bend, T* residual) const {
    using std::sqrt;
    const T squares = bend[0] * bend[0] + 0.5 * bend[1] * bend[1] + bend[2] * bend[2];
    residual[0] =
        (bend[0] * bend[2] - 0.25 * bend[1] * bend[1]) / sqrt(squares + loose * loose) / loose;
    return true;
  }
};

/// What is known of lenses before any photograph: nearly square pixels, and the rest loosely. It
/// decides only what photographs leave open, such as views that are all tilted alike.
struct LensPrior {
  double focal, focal_share;  ///< pixels, and the deviation of its logarithm
  glm::dvec2 size;            ///< pixels

  template <typename T>
  bool operator()(const T* lens, T* residual) const {
    constexpr double kSquare = 5e-4, kMiddle = 0.03, kRadial = 0.5, kTangential = 0.01;
    if (!(lens[0] > 0.0) || !(lens[1] > 0.0)) return false;
    using std::log;
    residual[0] = log(lens[0] / lens[1]) / kSquare;
    residual[1] = log(lens[0] / focal) / focal_share;
    residual[2] = (lens[2] - (size.x - 1) / 2) / (kMiddle * size.x);
    residual[3] = (lens[3] - (size.y - 1) / 2) / (kMiddle * size.x);
    for (int i = 4; i < 12; ++i) residual[i] = lens[i] / (i == 6 || i == 7 ? kTangential : kRadial);
    return true;
  }
};

}  // namespace photohull
